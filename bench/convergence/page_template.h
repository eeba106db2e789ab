#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace reemit::bench {

/// Text of a page with marks of the form @name@ where measured parts go.
class PageTemplate {
 public:
  /// Throws std::runtime_error when the file cannot be read.
  explicit PageTemplate(std::filesystem::path source);

  /// Puts `text` in place of the line @name@. Throws std::runtime_error if the template has none.
  void put(const std::string& name, const std::string& text);
  /// The same with a list of one item per note.
  void put_notes(const std::string& name, const std::vector<std::string>& notes);
  /// Throws std::runtime_error when the file cannot be written.
  void write(const std::filesystem::path& file) const;

 private:
  std::filesystem::path source_;
  std::string text_;
};

}  // namespace reemit::bench
