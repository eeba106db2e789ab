#pragma once
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <tiny_gltf.h>

#include "tests/support/temp_folder.h"

namespace reemit::test {

inline tinygltf::Model read_glb(const std::filesystem::path& file) {
  tinygltf::Model model;
  tinygltf::TinyGLTF loader;
  std::string error;
  std::string warning;
  EXPECT_TRUE(loader.LoadBinaryFromFile(&model, &error, &warning, file.string())) << error;
  EXPECT_EQ(warning, "");
  return model;
}

inline std::string first_line_of_issues(const std::string& report) {
  const auto json = nlohmann::json::parse(report, nullptr, false);
  return json.is_discarded() ? report : json["issues"].dump();
}

/// Runs the Khronos validator; skips the test when it is not installed.
inline void expect_valid_glb(const std::filesystem::path& file) {
  const std::filesystem::path modules = REEMIT_NODE_MODULES;
  if (std::system("node --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "node is not installed";
  if (!std::filesystem::exists(modules / "gltf-validator"))
    GTEST_SKIP() << "no gltf-validator in " << modules
                 << ": copy " REEMIT_SOURCE_DIR "/tests/viewer_export/gltf/package.json to "
                 << modules.parent_path() << " and run npm install there";
  const std::string report = file.string() + ".report";
  const std::string command = "node '" REEMIT_SOURCE_DIR "/tests/viewer_export/gltf/validate_glb.mjs' '" +
                              modules.string() + "' '" + file.string() + "' > '" + report + "' 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << first_line_of_issues(read_bytes(report));
}

}  // namespace reemit::test
