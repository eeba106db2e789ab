#pragma once
#include <compare>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "scenes/io/common/text_parse.h"
#include "scenes/io/mgf/mgf_colour.h"
#include "scenes/model/vec.h"

namespace reemit {

/// A photometric value and the colour it was given with.
struct MgfColoured {
  double value = 0;
  MgfColour colour;
  /// Where it was given, for messages, if the owner of the contexts keeps that. Not part of the value.
  const std::string* given_at = nullptr;

  bool operator==(const MgfColoured& other) const { return value == other.value && colour == other.colour; }
  std::partial_ordering operator<=>(const MgfColoured& other) const {
    return std::pair(value, colour) <=> std::pair(other.value, other.colour);
  }
};

/// State of an MGF material context; the default is a two-sided black absorber.
struct MgfMaterial {
  int sides = 2;
  MgfColoured rd, td, rs, ts;  ///< Reflectances and transmittances [0,1].
  MgfColoured ed;              ///< Emittance [lm/m2].
  double rs_roughness = 0, ts_roughness = 0;
  double ir_real = 1, ir_imaginary = 0;
  auto operator<=>(const MgfMaterial&) const = default;
};

/// State of an MGF vertex context, before any transform.
struct MgfVertex {
  Vec3 position{0, 0, 0};
  Vec3 normal{0, 0, 0};  ///< Zero: none; else unit.
  bool has_normal() const { return normal != Vec3(0, 0, 0); }
};

/// The contexts of one kind: named ones, and the unnamed one that always starts from the default [MGF].
template <class State>
class MgfNamedContexts {
 public:
  /// "c", "m" or "v" alone; with a name; with "name ="; with "name = template". Throws InputError at `where`.
  void select(const TextLine& line, const std::string& where);
  State& current() { return *current_; }
  const State& current() const { return *current_; }
  const std::string& current_name() const { return current_name_; }
  /// Throws InputError at `where` if the name is not defined.
  const State& find(std::string_view name, const std::string& where) const;

  MgfNamedContexts() = default;
  MgfNamedContexts(const MgfNamedContexts&) = delete;
  MgfNamedContexts& operator=(const MgfNamedContexts&) = delete;

 private:
  std::map<std::string, State, std::less<>> named_;  // a map, as current_ points into it
  State unnamed_;
  State* current_ = &unnamed_;
  std::string current_name_;
};

/// The current colour, material and vertex of an MGF file, and the entities that change them.
class MgfContexts {
 public:
  /// Runs c cxy cspec cct cmix, m sides rd td ed rs ts ir, v p n. False if the entity is none of these.
  /// Throws InputError at `where`.
  bool run(const TextLine& line, const std::string& where);
  /// Colours are judged here, when a face at `where` uses the current material, not where they are given:
  /// libraries hold colours to mix with, such as the components of daylight, that no light has. Throws
  /// InputError that also says where the colour was given.
  void check_current_material(const std::string& where) const;

  MgfNamedContexts<MgfColour> colours;
  MgfNamedContexts<MgfMaterial> materials;
  MgfNamedContexts<MgfVertex> vertices;

 private:
  bool run_colour(const TextLine& line, const std::string& where);
  bool run_material(const TextLine& line, const std::string& where);
  bool run_vertex(const TextLine& line, const std::string& where);
  void set_colour(const MgfColour& colour, const std::string& where);
  std::set<std::string> given_at_;  // given_at of MgfColour and MgfColoured point into it
};

/// Number at word `index` of a line; throws InputError at `where` if there is none.
double mgf_number(const TextLine& line, std::size_t index, const std::string& where);

/// Throws InputError at `where` unless the line has from least to most arguments after its keyword.
void check_argument_count(const TextLine& line, std::size_t least, std::size_t most,
                          const std::string& where);

}  // namespace reemit
