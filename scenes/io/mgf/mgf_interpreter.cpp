#include "scenes/io/mgf/mgf_interpreter.h"

#include <algorithm>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "scenes/io/common/text_file.h"
#include "scenes/io/mgf/mgf_shapes.h"
#include "scenes/model/error.h"

namespace reemit {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kDeepestInclude = 100;
constexpr std::size_t kDeepestObject = 1000;
constexpr std::uint64_t kMostEntities = 10'000'000;  // executed, arrays and includes unrolled
constexpr std::uint64_t kMostIncludes = 1'000'000;
constexpr std::uintmax_t kMostFileBytes = std::uintmax_t{1} << 30;  // of all files of a room

std::span<const std::string_view> words_from(const TextLine& line, std::size_t first) {
  return std::span(line.words).subspan(std::min(first, line.words.size()));
}

fs::path identity_of(const fs::path& file) {
  std::error_code error;
  fs::path path = fs::canonical(file, error);
  return error ? file : path;
}

}  // namespace

fs::path mgf_mentioned_file(const fs::path& folder, std::string_view name, const std::string& where) {
  const fs::path path{std::string(name)};
  if (path.is_absolute())
    throw InputError(where, fmt::format("'{}' is not relative to this file", name),
                     "Give the path from the folder of the file that mentions it.");
  return folder / path;
}

void MgfInterpreter::run(const fs::path& file) {
  run_file(load(file, ""));
}

const MgfInterpreter::File& MgfInterpreter::load(const fs::path& file, const std::string& included_from) {
  const File& loaded = file_at(file, included_from);
  if (open_files_.size() >= kDeepestInclude)
    throw InputError(included_from, "includes are nested too deep: " + chain_of_includes(loaded),
                     fmt::format("At most {}.", kDeepestInclude));
  if (std::find(open_files_.begin(), open_files_.end(), &loaded) != open_files_.end())
    throw InputError(included_from, "files include each other in a circle: " + chain_of_includes(loaded),
                     "Remove one of these includes.");
  if (!included_from.empty() && ++includes_ > kMostIncludes)
    throw InputError(included_from,
                     fmt::format("more than {} files are included, counted each time: {}", kMostIncludes,
                                 chain_of_includes(loaded)),
                     "Files that include others several times multiply: check these, and the counts of the "
                     "arrays (-a) around them.");
  open_files_.push_back(&loaded);
  return loaded;
}

const MgfInterpreter::File& MgfInterpreter::file_at(const fs::path& file, const std::string& included_from) {
  const File*& spelled = files_by_spelling_[file];
  if (spelled != nullptr) return *spelled;
  const fs::path identity = identity_of(file);
  std::unique_ptr<File>& entry = files_[identity];
  if (!entry) {
    auto loaded = std::make_unique<File>();
    loaded->path = identity;
    loaded->name = file.lexically_normal().string();
    loaded->folder = file.parent_path();
    try {
      loaded->text = load_file(file, kMostFileBytes - bytes_);
    } catch (const InputError& error) {
      if (included_from.empty()) throw;
      throw InputError(included_from, std::string("the included file cannot be read: ") + error.what(), "");
    }
    bytes_ += loaded->text.size();
    loaded->lines = split_lines(loaded->text);
    entry = std::move(loaded);
  }
  spelled = entry.get();
  return *spelled;
}

std::string MgfInterpreter::chain_of_includes(const File& last) const {
  std::string chain;
  for (const File* open : open_files_) chain += open->path.filename().string() + " -> ";
  return chain + last.path.filename().string();
}

void MgfInterpreter::run_file(const File& file) {
  const std::size_t outer_frames = std::exchange(frames_before_file_, frames_.size());
  const std::size_t outer_objects = std::exchange(objects_before_file_, objects_.size());
  for (std::size_t next = 0; next < file.lines.size();) run_line(file, next);
  close_what_is_open(file);
  frames_before_file_ = outer_frames;
  objects_before_file_ = outer_objects;
  open_files_.pop_back();
}

// `next` is the line to run; afterwards the one to run then, which is further up when an array repeats.
void MgfInterpreter::run_line(const File& file, std::size_t& next) {
  const TextLine& line = file.lines[next++];
  const std::string_view keyword = line.words[0];
  if (keyword[0] == '#') return;
  const std::string where = at_line(file.name, line.number);
  if (++executed_ > kMostEntities)
    throw InputError(where, fmt::format("more than {} entities", kMostEntities),
                     "Check the counts of the arrays (-a) here and around it.");
  if (contexts_.run(line, where) || run_geometry(file, line, where)) return;
  if (keyword == "xf") {
    run_xf(line, where, next);
  } else if (keyword == "o") {
    run_object(line, where);
  } else if (keyword == "i") {
    run_include(file, line, where);
  } else if (keyword == "ies") {
    run_ies(file, line, where);
  } else {
    ++builder_.refused["statements"];
    if (unknown_entities_.emplace(keyword).second)
      builder_.warnings.push_back(fmt::format(
          "{}: '{}' is not an MGF entity; it is ignored here and wherever it comes again.", where, keyword));
  }
}

void MgfInterpreter::begin_transform(MgfTransform transform, std::size_t first_line) {
  frames_.push_back({std::move(transform), transform_, -1, first_line});
  next_instance();
}

bool MgfInterpreter::next_instance() {
  Frame& frame = frames_.back();
  if (++frame.instance < frame.transform.instance_count()) {
    transform_ = frame.outside * frame.transform.instance(frame.instance);
    return true;
  }
  transform_ = frame.outside;
  frames_.pop_back();
  return false;
}

void MgfInterpreter::run_xf(const TextLine& line, const std::string& where, std::size_t& next) {
  if (line.words.size() > 1) {
    begin_transform(MgfTransform(words_from(line, 1), where), next);
    return;
  }
  if (frames_.size() <= frames_before_file_)
    throw InputError(where, "'xf' ends a transform that was not begun in this file",
                     "Remove it, or begin the transform with 'xf' and its arguments.");
  const std::size_t first_line = frames_.back().first_line;
  if (next_instance()) next = first_line;
}

void MgfInterpreter::run_object(const TextLine& line, const std::string& where) {
  check_argument_count(line, 0, 1, where);
  if (line.words.size() == 2) {
    if (objects_.size() >= kDeepestObject)
      throw InputError(where, "objects are nested too deep", "Does every 'o name' have its 'o'?");
    objects_.emplace_back(line.words[1]);
  } else {
    if (objects_.size() <= objects_before_file_)
      throw InputError(where, "'o' ends an object that was not begun in this file",
                       "Remove it, or begin the object with 'o' and its name.");
    objects_.pop_back();
  }
  object_path_ = fmt::format("{}", fmt::join(objects_, "/"));
}

void MgfInterpreter::run_include(const File& file, const TextLine& line, const std::string& where) {
  if (line.words.size() < 2) throw InputError(where, "'i' names no file", "Write 'i file.mgf [transform]'.");
  const fs::path path = mgf_mentioned_file(file.folder, line.words[1], where);
  if (line.words.size() == 2) {
    run_file(load(path, where));
    return;
  }
  begin_transform(MgfTransform(words_from(line, 2), where), 0);
  do {
    run_file(load(path, where));
  } while (next_instance());
}

void MgfInterpreter::close_what_is_open(const File& file) {
  if (frames_.size() > frames_before_file_) {
    builder_.warnings.push_back(
        fmt::format("{}: {} 'xf' without an end; it ends with the file, arrays are not repeated.", file.name,
                    frames_.size() - frames_before_file_));
    transform_ = frames_[frames_before_file_].outside;
    frames_.resize(frames_before_file_);
  }
  if (objects_.size() > objects_before_file_) {
    builder_.warnings.push_back(fmt::format("{}: {} object(s) without an end; they end with the file.",
                                            file.name, objects_.size() - objects_before_file_));
    objects_.resize(objects_before_file_);
    object_path_ = fmt::format("{}", fmt::join(objects_, "/"));
  }
}

}  // namespace reemit
