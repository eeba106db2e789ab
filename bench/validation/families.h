#pragma once
#include <functional>
#include <string>
#include <vector>

#include "bench/validation/reference_cases.h"
#include "bench/validation/validation_row.h"

namespace reemit::validation {

/// Evaluators, one per family of kinds. Each gets cases of its own kinds only, and returns a row or more for
/// every value. Results depend on the cases and the effort alone.

/// Form factors between surfaces and shares of power: packets shot and walked. vf_*, flux_split,
/// irr_mean_rect.
std::vector<ValidationRow> evaluate_form_factors(const std::vector<ReferenceCase>& cases,
                                                 const Effort& effort);

/// Direct irradiance at a point: irr_*, sky_opening, point_source.
std::vector<ValidationRow> evaluate_direct_light(const std::vector<ReferenceCase>& cases,
                                                 const Effort& effort);

/// Flux and direct illuminance of measured luminaires: ies_axial, ies_planes.
std::vector<ValidationRow> evaluate_measured_luminaires(const std::vector<ReferenceCase>& cases,
                                                        const Effort& effort);

/// Rooms whose mean or whole solution follows from their energy balance: furnace, furnace_var,
/// integrating_sphere, energy_closed, concentric.
std::vector<ValidationRow> evaluate_enclosures(const std::vector<ReferenceCase>& cases, const Effort& effort);

/// Gathered light against solutions of the continuous equation: radiosity_continuous, lroom_continuous,
/// plates_finite.
std::vector<ValidationRow> evaluate_continuous(const std::vector<ReferenceCase>& cases, const Effort& effort);

/// Light over mirrors: images of a luminaire at a point, and rooms that mirrors close or make endless.
/// mirror_images, mirror_finite, light_pipe, plates_infinite, crease_infinite, radiosity_mirror_continuous.
std::vector<ValidationRow> evaluate_mirrors(const std::vector<ReferenceCase>& cases, const Effort& effort);

/// What thin panes and surfaces of glass reflect and let through: slab_direct, fresnel_slab, fresnel_hemi.
std::vector<ValidationRow> evaluate_glass(const std::vector<ReferenceCase>& cases, const Effort& effort);

/// Light that comes diffusely through sheets: opal_between_plates, opal_panel_point.
std::vector<ValidationRow> evaluate_opal(const std::vector<ReferenceCase>& cases, const Effort& effort);

/// Zone values against the exact zonal system: zone_*, lroom_zone.
std::vector<ValidationRow> evaluate_zonal(const std::vector<ReferenceCase>& cases, const Effort& effort);

struct Family {
  std::string name;
  std::vector<std::string> kinds;
  std::function<std::vector<ValidationRow>(const std::vector<ReferenceCase>&, const Effort&)> evaluate;
};

/// All families, in the order of the page.
std::vector<Family> families();

/// The cases of the given kinds.
std::vector<ReferenceCase> cases_of(const std::vector<ReferenceCase>& cases,
                                    const std::vector<std::string>& kinds);

}  // namespace reemit::validation
