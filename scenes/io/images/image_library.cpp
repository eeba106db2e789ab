#include "scenes/io/images/image_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "scenes/model/error.h"

#include "reemit/version.h"

namespace reemit {
namespace {

constexpr const char* kModule = REEMIT_IMAGE_MODULE;

[[noreturn]] void fail(const std::string& problem) {
  throw ResourceError(
      kModule, "reading and writing images needs this file: " + problem,
      "It is installed in the folder reemit beside the libraries, and made beside the program by a build. "
      "If it was moved, name its folder in LD_LIBRARY_PATH.");
}

// What the last call has to say.
std::string loader_message() {
  const char* message = dlerror();
  return message == nullptr ? "no reason is given" : message;
}

const ImageLibrary& load() {
  // Global as if it had been linked, behind all that was: scopes of their own take its libraries half as long
  // again to load. Never unloaded: they may have threads, and what was handed out lives on.
  void* const module = dlopen(kModule, RTLD_LAZY | RTLD_GLOBAL);
  if (module == nullptr) fail(loader_message());
  const auto library = reinterpret_cast<ImageLibraryFunction>(dlsym(module, kImageLibraryFunction));
  if (library == nullptr) fail(loader_message());
  const ImageLibrary* const found = library(kProgramVersion);
  if (found == nullptr) fail(fmt::format("the one that was found is not of version {}", kProgramVersion));
  return *found;
}

}  // namespace

const ImageLibrary& image_library() {
  static const ImageLibrary& library = load();
  return library;
}

}  // namespace reemit
