#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/io/common/text_parse.h"
#include "scenes/io/mgf/mgf_contexts.h"
#include "scenes/io/mgf/mgf_scene_builder.h"
#include "scenes/io/mgf/mgf_transform.h"
#include "scenes/io/photometry/measured_luminaire.h"
#include "scenes/model/scene.h"

namespace reemit {

/// Runs the entities of an MGF file and of what it includes, in order, as an interpreter: contexts,
/// transforms and objects are its state, geometry its output.
class MgfInterpreter {
 public:
  /// Runs one more file of the room: contexts stay as the files before it left them, transforms and objects
  /// end with their file. Throws InputError with file and line.
  void run(const std::filesystem::path& file);
  /// Moves materials, surfaces, lights and warnings into the scene.
  void finish(Scene& scene);
  std::size_t tessellated_count() const { return tessellated_count_; }

 private:
  struct File {
    std::filesystem::path path;  // canonical
    std::string name;            // as messages show it
    std::filesystem::path folder;
    std::string text;
    std::vector<TextLine> lines;
  };
  // An open xf: its instances run one after the other from the line after it.
  struct Frame {
    MgfTransform transform;
    Eigen::Affine3d outside;  // in effect around it
    std::int64_t instance = 0;
    std::size_t first_line = 0;
  };

  const File& load(const std::filesystem::path& file, const std::string& included_from);
  const File& file_at(const std::filesystem::path& file, const std::string& included_from);
  std::string chain_of_includes(const File& last) const;
  void run_file(const File& file);
  void run_line(const File& file, std::size_t& next);
  void begin_transform(MgfTransform transform, std::size_t first_line);
  bool next_instance();  // false: it was the last, and the frame is gone
  void run_xf(const TextLine& line, const std::string& where, std::size_t& next);
  void run_object(const TextLine& line, const std::string& where);
  void run_include(const File& file, const TextLine& line, const std::string& where);
  void run_ies(const File& file, const TextLine& line, const std::string& where);
  bool run_geometry(const File& file, const TextLine& line, const std::string& where);
  std::vector<Polygon> faces_of(const TextLine& line, const std::string& where);
  CurvedShape curved_shape_of(const TextLine& line, const std::string& where);
  std::vector<MgfVertex> vertices_of(const TextLine& line, std::size_t first, std::size_t last,
                                     const std::string& where) const;
  std::vector<Polygon> face_with_holes(const TextLine& line, const std::string& where) const;
  void close_what_is_open(const File& file);

  static constexpr std::size_t kMostLuminaires = 100'000;

  MgfContexts contexts_;
  MgfSceneBuilder builder_;
  std::map<std::filesystem::path, std::unique_ptr<File>> files_;    // by canonical path
  std::map<std::filesystem::path, const File*> files_by_spelling_;  // as entities name them
  std::vector<const File*> open_files_;                             // chain of includes
  std::uintmax_t bytes_ = 0;                                        // of all files
  std::uint64_t includes_ = 0;                                      // run, repeated ones each time
  std::vector<Frame> frames_;
  std::vector<std::string> objects_;
  std::string object_path_;
  std::size_t frames_before_file_ = 0, objects_before_file_ = 0;
  Eigen::Affine3d transform_ = Eigen::Affine3d::Identity();
  std::set<std::string> unknown_entities_;
  std::uint64_t executed_ = 0;
  std::size_t tessellated_count_ = 0;
  LuminaireLibrary luminaires_;
  std::vector<PunctualLight> lights_;
  std::vector<std::string> notes_;
};

/// A file that an entity names: relative to the file with the entity, with '/' between folders. Throws
/// InputError at `where` if the name is absolute.
std::filesystem::path mgf_mentioned_file(const std::filesystem::path& folder, std::string_view name,
                                         const std::string& where);

}  // namespace reemit
