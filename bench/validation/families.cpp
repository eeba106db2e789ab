#include "bench/validation/families.h"

#include <algorithm>

namespace reemit::validation {

std::vector<Family> families() {
  return {
      {"form factors",
       {"vf_parallel_rects", "vf_perp_rects", "vf_coaxial_disks", "vf_sphere_disk", "vf_closed_cylinder",
        "vf_obstructed", "flux_split", "irr_mean_rect"},
       evaluate_form_factors},
      {"direct light",
       {"irr_polygon", "irr_disk", "irr_disk_clipped", "irr_sphere", "irr_cylinder", "irr_rect_occluded",
        "irr_cornell_blocks", "point_source", "sky_opening"},
       evaluate_direct_light},
      {"measured luminaires", {"ies_axial", "ies_planes"}, evaluate_measured_luminaires},
      {"enclosures",
       {"furnace", "furnace_var", "integrating_sphere", "energy_closed", "concentric"},
       evaluate_enclosures},
      {"continuous rooms",
       {"radiosity_continuous", "lroom_continuous", "plates_finite"},
       evaluate_continuous},
      {"mirrors",
       {"mirror_images", "mirror_finite", "light_pipe", "plates_infinite", "crease_infinite",
        "radiosity_mirror_continuous"},
       evaluate_mirrors},
      {"glass", {"slab_direct", "fresnel_slab", "fresnel_hemi"}, evaluate_glass},
      {"opal sheets", {"opal_between_plates", "opal_panel_point"}, evaluate_opal},
      {"zonal systems",
       {"zone_box", "zone_cube_NxN", "zone_cube_triangles", "zone_icosphere", "zone_cylinder", "lroom_zone"},
       evaluate_zonal}};
}

std::vector<ReferenceCase> cases_of(const std::vector<ReferenceCase>& cases,
                                    const std::vector<std::string>& kinds) {
  std::vector<ReferenceCase> result;
  std::copy_if(cases.begin(), cases.end(), std::back_inserter(result), [&](const ReferenceCase& c) {
    return std::find(kinds.begin(), kinds.end(), c.kind) != kinds.end();
  });
  return result;
}

}  // namespace reemit::validation
