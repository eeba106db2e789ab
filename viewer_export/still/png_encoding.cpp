#include "viewer_export/still/png_encoding.h"

#include <algorithm>
#include <exception>
#include <memory>

#include <png.h>

#include "scenes/model/error.h"

namespace reemit {
namespace {

/// What libpng calls back with, and what went wrong meanwhile.
struct Target {
  OutputFile& file;
  std::exception_ptr not_written;
  std::string problem;
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  static_cast<Target*>(png_get_error_ptr(png))->problem = message;
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

void write_bytes(png_structp png, png_bytep bytes, png_size_t size) {
  Target& target = *static_cast<Target*>(png_get_io_ptr(png));
  try {
    target.file.write(bytes, size);
  } catch (...) {  // must not cross code in C
    target.not_written = std::current_exception();
  }
  if (target.not_written) png_error(png, "not written");
}

void ignore_flush(png_structp) {}

std::vector<png_text> texts_of(const PngPicture& picture) {
  std::vector<png_text> texts;
  for (const auto& [keyword, text] : picture.texts) {
    const bool is_ascii =
        std::all_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 128; });
    png_text chunk{};
    chunk.compression = is_ascii ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
    // libpng copies what it is given, and does not change it.
    chunk.key = const_cast<char*>(keyword.c_str());
    chunk.text = const_cast<char*>(text.c_str());
    texts.push_back(chunk);
  }
  return texts;
}

/// False if libpng gave up: it jumps back here, so nothing here may have a destructor.
bool encode(png_structp png, png_infop info, const PngPicture& picture, const std::vector<png_text>& texts,
            Target& target) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &target, write_bytes, ignore_flush);
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height),
               8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
  png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
  png_write_info(png, info);
  const std::size_t stride = std::size_t{3} * static_cast<std::size_t>(picture.width);
  for (std::size_t at = 0; at < picture.rgb.size(); at += stride) png_write_row(png, &picture.rgb[at]);
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

void encode_png(const PngPicture& picture, OutputFile& file) {
  const std::vector<png_text> texts = texts_of(picture);  // may throw, so before what has to be freed
  Target target{file, nullptr, ""};
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &target, on_error, ignore_warning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  const bool done = info != nullptr && encode(png, info, picture, texts, target);
  png_destroy_write_struct(&png, &info);
  if (target.not_written) std::rethrow_exception(target.not_written);
  if (!done)
    throw ResourceError("PNG image", "libpng cannot write it: " + target.problem,
                        "Write .exr instead, or a smaller picture.");
}

}  // namespace reemit
