#pragma once
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "scenes/model/vec.h"

namespace reemit::validation {

/// One number that is known without Monte Carlo. Units follow from the quantity: lengths in metres unless the
/// parameters say mm, E and H irradiances [W/m2 or lx], F form factors [1].
struct ReferenceValue {
  std::string id;        ///< Unique.
  std::string quantity;  ///< What of the case it is, e.g. "H_mean on face x0".
  double value = 0;
  double abs_err = 0;           ///< 0 for closed forms.
  std::optional<Vec3> point;    ///< [m], for values at a point.
  Vec3 normal = Vec3::UnitZ();  ///< At `point`; unit.
};

/// One geometry with its parameters and all that is known about it.
struct ReferenceCase {
  std::string name;
  std::string kind;  ///< Selects the evaluator.
  std::string title;
  std::string source;  ///< Where the values come from.
  nlohmann::json parameters;
  std::vector<ReferenceValue> values;
};

/// Reads bench/validation/cases.json. Throws InputError when the file cannot be read or is not as expected.
std::vector<ReferenceCase> read_reference_cases(const std::string& path);

/// The file of the source tree this program was built from.
std::string reference_cases_path();

/// Three numbers of a JSON array.
Vec3 to_vec3(const nlohmann::json& array);

}  // namespace reemit::validation
