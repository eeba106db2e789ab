#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "mesh/build_mesh.h"
#include "scenes/model/scene.h"
#include "viewer_export/cli/command_options.h"

namespace reemit::cli {

/// Refuses a name, before the work, that `--report` cannot have: another extension, no place to write, one of
/// the files of the room. Throws InputError or OutputError.
void check_report(const std::filesystem::path& report, const std::vector<std::filesystem::path>& room);

/// The same for files that those of the room name, which only reading it shows. Then draws the picture and
/// writes it.
void write_report(const std::filesystem::path& report, const Scene& scene, const MeshResult& meshed,
                  const OutputStyle& style);

/// What `info --report` prints: what the picture shows in which colour, the first faces of every kind by
/// name, and how large zones are.
std::string inspection_text(const Scene& scene, const MeshResult& meshed,
                            const std::filesystem::path& report);
/// Sets "changed_faces" and "zone_sizes" (docs/command_line.md), and with a name of a file "report".
void add_inspection(nlohmann::ordered_json& json, const Scene& scene, const MeshResult& meshed,
                    const std::filesystem::path& report);

}  // namespace reemit::cli
