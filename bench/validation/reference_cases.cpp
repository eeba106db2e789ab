#include "bench/validation/reference_cases.h"

#include <fstream>

#include "scenes/model/error.h"

namespace reemit::validation {

Vec3 to_vec3(const nlohmann::json& array) {
  return {array.at(0).get<double>(), array.at(1).get<double>(), array.at(2).get<double>()};
}

std::string reference_cases_path() {
  return REEMIT_SOURCE_DIR "/bench/validation/cases.json";
}

std::vector<ReferenceCase> read_reference_cases(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw InputError(path, "the reference cases cannot be read", "Run from a complete source tree.");
  std::vector<ReferenceCase> cases;
  try {
    for (const nlohmann::json& entry : nlohmann::json::parse(file)) {
      ReferenceCase& c = cases.emplace_back();
      c.name = entry.at("case").get<std::string>();
      c.kind = entry.at("kind").get<std::string>();
      c.title = entry.at("title").get<std::string>();
      c.source = entry.at("source").get<std::string>();
      c.parameters = entry.at("parameters");
      for (const nlohmann::json& row : entry.at("values")) {
        ReferenceValue& v = c.values.emplace_back();
        v.id = row.at("id").get<std::string>();
        v.quantity = row.at("quantity").get<std::string>();
        v.value = row.at("value").get<double>();
        v.abs_err = row.at("abs_err").get<double>();
        if (!row.contains("point")) continue;
        v.point = to_vec3(row.at("point"));
        v.normal = to_vec3(row.at("normal"));
      }
    }
  } catch (const nlohmann::json::exception& e) {
    throw InputError(path, e.what(), "The file is damaged: restore it.");
  }
  return cases;
}

}  // namespace reemit::validation
