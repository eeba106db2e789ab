#include "scenes/io/mgf/mgf_reader.h"

#include <fmt/format.h>

#include "scenes/io/mgf/mgf_interpreter.h"

namespace reemit {

Scene read_mgf_scene(const std::filesystem::path& file, const ReadOptions& /*options*/) {
  return read_mgf_files({&file, 1});
}

Scene read_mgf_files(std::span<const std::filesystem::path> files) {
  Scene scene;
  scene.bands = BandSet::rgb();
  MgfInterpreter interpreter;
  for (const std::filesystem::path& file : files) {
    interpreter.run(file);
    if (!scene.name.empty()) scene.name += "+";
    if (!scene.source.empty()) scene.source += " + ";
    scene.name += file.stem().string();
    scene.source += file.string();
  }
  interpreter.finish(scene);
  scene.notes.push_back(
      "MGF: metres; emittance in lm/m2 was divided by pi and 179 lm/W; colours are linear Rec.709, "
      "equal-energy white is neutral.");
  if (interpreter.tessellated_count() > 0)
    scene.notes.push_back(fmt::format("{} tori were tessellated with 16 to 32 segments per circle.",
                                      interpreter.tessellated_count()));
  std::string emitters;
  bool one_sided = false;
  for (const Material& m : scene.materials) {
    if (m.emits_both_sides) emitters += fmt::format("{}'{}'", emitters.empty() ? "" : ", ", m.name);
    one_sided = one_sided || !m.two_sided;
  }
  if (!emitters.empty())
    scene.notes.push_back("Two-sided materials look the same from both sides in MGF, so both sides emit: " +
                          emitters);
  if (one_sided)
    scene.notes.push_back("One-sided surfaces are invisible from the back in MGF; here their back absorbs.");
  return scene;
}

}  // namespace reemit
