#include "scenes/io/mgf/mgf_contexts.h"

#include <fmt/format.h>

#include "scenes/model/error.h"
#include "scenes/model/limits.h"

namespace reemit {
namespace {

constexpr std::size_t kAnyNumber = static_cast<std::size_t>(-1);

double fraction_at(const TextLine& line, std::size_t index, const std::string& where) {
  const double value = mgf_number(line, index, where);
  if (value < 0 || value > 1)
    throw InputError(where, fmt::format("'{} {}' is outside [0, 1]", line.words[0], line.words[index]),
                     "Reflectances and transmittances are fractions.");
  return value;
}

double at_least_zero(const TextLine& line, std::size_t index, const std::string& where) {
  const double value = mgf_number(line, index, where);
  if (value < 0)
    throw InputError(where, fmt::format("'{} {}' is negative", line.words[0], line.words[index]),
                     "Give 0 or more.");
  return value;
}

Vec3 vector_at(const TextLine& line, const std::string& where) {
  check_argument_count(line, 3, 3, where);
  return {mgf_number(line, 1, where), mgf_number(line, 2, where), mgf_number(line, 3, where)};
}

// What reflects or sends nothing has no colour.
MgfColoured coloured(double value, const MgfColour& colour) {
  return {value, value > 0 ? colour : MgfColour{}};
}

MgfColour parse_spectrum(const TextLine& line, const std::string& where) {
  check_argument_count(line, 4, kAnyNumber, where);
  const double from = mgf_number(line, 1, where);
  const double to = mgf_number(line, 2, where);
  if (!(from > 0 && from < to))
    throw InputError(where, "the wavelengths of 'cspec' do not increase",
                     "Give the shorter one first, in nm.");
  std::vector<double> samples;
  for (std::size_t i = 3; i < line.words.size(); ++i) samples.push_back(mgf_number(line, i, where));
  return colour_of_spectrum(from, to, samples);
}

MgfColour parse_black_body(const TextLine& line, const std::string& where) {
  check_argument_count(line, 1, 1, where);
  const double kelvin = mgf_number(line, 1, where);
  constexpr double kColdest = 500,
                   kHottest = 1e6;  // below, nothing is visible; above, the colour does not change
  if (kelvin < kColdest || kelvin > kHottest)
    throw InputError(where, fmt::format("colour temperature {} K", kelvin),
                     fmt::format("Give a temperature from {} to {} K.", kColdest, kHottest));
  return colour_of_black_body(kelvin);
}

}  // namespace

double mgf_number(const TextLine& line, std::size_t index, const std::string& where) {
  const std::optional<double> value = parse_number(line.words.at(index));
  if (!value)
    throw InputError(where, fmt::format("'{}' is not a number", line.words[index]),
                     fmt::format("Argument {} of '{}' must be a finite number.", index, line.words[0]));
  return *value;
}

void check_argument_count(const TextLine& line, std::size_t least, std::size_t most,
                          const std::string& where) {
  const std::size_t count = line.words.size() - 1;
  if (count >= least && count <= most) return;
  const std::string wanted = most == kAnyNumber ? fmt::format("at least {}", least)
                             : least == most    ? fmt::format("{}", least)
                                                : fmt::format("{} to {}", least, most);
  throw InputError(where, fmt::format("'{}' has {} arguments", line.words[0], count),
                   fmt::format("It takes {}.", wanted));
}

template <class State>
void MgfNamedContexts<State>::select(const TextLine& line, const std::string& where) {
  check_argument_count(line, 0, 3, where);
  const auto& words = line.words;
  if (words.size() == 1) {
    unnamed_ = State{};
    current_ = &unnamed_;
    current_name_.clear();
    return;
  }
  if (words.size() >= 3 && words[2] != "=")
    throw InputError(where, fmt::format("'{}' where '=' is expected", words[2]),
                     fmt::format("Write '{} name = [template]', with blanks around the '='.", words[0]));
  if (words.size() >= 3) {
    State state = words.size() == 4 ? find(words[3], where) : State{};
    current_ = &named_.insert_or_assign(std::string(words[1]), std::move(state)).first->second;
  } else {
    current_ = const_cast<State*>(&find(words[1], where));
  }
  current_name_ = words[1];
}

template <class State>
const State& MgfNamedContexts<State>::find(std::string_view name, const std::string& where) const {
  const auto found = named_.find(name);
  if (found == named_.end())
    throw InputError(where, fmt::format("'{}' is not defined", name),
                     fmt::format("Define it above with '{} =' after its keyword. If another file defines it, "
                                 "name that file before this one on the command line.",
                                 name));
  return found->second;
}

template class MgfNamedContexts<MgfColour>;
template class MgfNamedContexts<MgfMaterial>;
template class MgfNamedContexts<MgfVertex>;

bool MgfContexts::run(const TextLine& line, const std::string& where) {
  return run_vertex(line, where) || run_material(line, where) || run_colour(line, where);
}

void MgfContexts::set_colour(const MgfColour& colour, const std::string& where) {
  colours.current() = colour;
  if (!is_valid_chromaticity(colour.x, colour.y))
    colours.current().given_at = &*given_at_.insert(where).first;
}

void MgfContexts::check_current_material(const std::string& where) const {
  const MgfMaterial& m = materials.current();
  for (const MgfColoured* part : {&m.rd, &m.td, &m.rs, &m.ts, &m.ed}) {
    if (is_valid_chromaticity(part->colour.x, part->colour.y)) continue;
    throw InputError(
        where,
        fmt::format("{} has the colour of {}, and no light has its chromaticity ({:.4g}, {:.4g})",
                    materials.current_name().empty() ? std::string("the unnamed material")
                                                     : fmt::format("material '{}'", materials.current_name()),
                    *part->colour.given_at, part->colour.x, part->colour.y),
        "Give the material another colour: x, y and 1-x-y must not be negative, y not 0, and a spectrum "
        "needs light between 360 and 830 nm.");
  }
}

bool MgfContexts::run_colour(const TextLine& line, const std::string& where) {
  const std::string_view keyword = line.words[0];
  if (keyword == "c") {
    colours.select(line, where);
  } else if (keyword == "cxy") {
    check_argument_count(line, 2, 2, where);
    set_colour({mgf_number(line, 1, where), mgf_number(line, 2, where)}, where);
  } else if (keyword == "cspec") {
    set_colour(parse_spectrum(line, where), where);
  } else if (keyword == "cct") {
    set_colour(parse_black_body(line, where), where);
  } else if (keyword == "cmix") {
    check_argument_count(line, 2, kAnyNumber, where);
    if (line.words.size() % 2 == 0)
      throw InputError(where, "'cmix' has a weight without a colour",
                       "Write 'cmix weight colour weight colour ...'.");
    std::vector<std::pair<double, MgfColour>> parts;
    for (std::size_t i = 1; i + 1 < line.words.size(); i += 2)
      parts.emplace_back(mgf_number(line, i, where), colours.find(line.words[i + 1], where));
    set_colour(mix_colours(parts), where);
  } else {
    return false;
  }
  return true;
}

bool MgfContexts::run_material(const TextLine& line, const std::string& where) {
  const std::string_view keyword = line.words[0];
  MgfMaterial& material = materials.current();
  const MgfColour& colour = colours.current();
  if (keyword == "m") {
    materials.select(line, where);
  } else if (keyword == "sides") {
    check_argument_count(line, 1, 1, where);
    const auto sides = parse_integer(line.words[1]);
    if (!sides || *sides < 1 || *sides > 2)
      throw InputError(where, "'sides' is neither 1 nor 2", "Give 1 or 2.");
    material.sides = static_cast<int>(*sides);
  } else if (keyword == "rd" || keyword == "td") {
    check_argument_count(line, 1, 1, where);
    (keyword == "rd" ? material.rd : material.td) = coloured(fraction_at(line, 1, where), colour);
  } else if (keyword == "ed") {
    check_argument_count(line, 1, 1, where);
    material.ed = coloured(at_least_zero(line, 1, where), colour);
    material.ed.given_at = &*given_at_.insert(where).first;
  } else if (keyword == "rs" || keyword == "ts") {
    check_argument_count(line, 2, 2, where);
    (keyword == "rs" ? material.rs : material.ts) = coloured(fraction_at(line, 1, where), colour);
    (keyword == "rs" ? material.rs_roughness : material.ts_roughness) = at_least_zero(line, 2, where);
  } else if (keyword == "ir") {
    check_argument_count(line, 2, 2, where);
    material.ir_real = at_least_zero(line, 1, where);
    material.ir_imaginary = mgf_number(line, 2, where);
  } else {
    return false;
  }
  return true;
}

bool MgfContexts::run_vertex(const TextLine& line, const std::string& where) {
  const std::string_view keyword = line.words[0];
  if (keyword == "v") {
    vertices.select(line, where);
  } else if (keyword == "p") {
    vertices.current().position = vector_at(line, where);
    const std::string problem = place_problem(vertices.current().position);
    if (!problem.empty()) throw InputError(where, problem, kLengthAdvice);
  } else if (keyword == "n") {
    const Vec3 direction = vector_at(line, where);
    vertices.current().normal = direction.stableNormalized();
  } else {
    return false;
  }
  return true;
}

}  // namespace reemit
