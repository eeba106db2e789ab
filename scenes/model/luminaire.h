#pragma once
#include <cstdint>
#include <memory>
#include <string>
#include <variant>

#include "scenes/model/bands.h"
#include "scenes/model/photometry.h"
#include "scenes/model/vec.h"

namespace reemit {

/// Luminaires that rays do not see. Emissive surfaces are luminaires by their Material and are not listed
/// here. for_each_value() shows a visitor everything that light depends on, for the content hash.
struct PointLight {
  static constexpr const char* kKind = "point";
  std::string name;
  Vec3 position;       ///< [m]
  Spectrum intensity;  ///< [W/sr] per band, the same in all directions.

  template <class Visit>
  void for_each_value(Visit&& visit) const {
    visit(position);
    visit(intensity);
  }
};

/// Intensity falls from full inside the inner cone to 0 at the outer cone as KHR_lights_punctual states it.
struct SpotLight {
  static constexpr const char* kKind = "spot";
  std::string name;
  Vec3 position;              ///< [m]
  Vec3 direction;             ///< Unit, away from the lamp.
  Spectrum intensity;         ///< [W/sr] per band on the axis.
  double inner_angle = 0;     ///< Half angle [rad], 0 <= inner < outer.
  double outer_angle = 0.78;  ///< Half angle [rad], <= pi/2.

  template <class Visit>
  void for_each_value(Visit&& visit) const {
    visit(position);
    visit(intensity);
    visit(direction);
    visit(inner_angle);
    visit(outer_angle);
  }
};

/// Parallel light from infinitely far away.
struct DirectionalLight {
  static constexpr const char* kKind = "directional";
  std::string name;
  Vec3 direction;       ///< Unit, the way the light travels.
  Spectrum irradiance;  ///< [W/m2] per band on a plane across the beam.

  template <class Visit>
  void for_each_value(Visit&& visit) const {
    visit(irradiance);
    visit(direction);
  }
};

/// A measured luminaire [LM63]: every point of its opening sends out the same distribution of intensity
/// (photometrically homogeneous aperture). It is light only: rays do not see it and it casts no shadow.
struct PhotometricLight {
  static constexpr const char* kKind = "ies";
  std::string name;
  Vec3 position;  ///< Centre of the opening [m].
  /// Luminaire coordinates (photometry.h) to the room: the columns are the directions of C = 0, C = 90 and
  /// up. Orthogonal; a determinant of -1 mirrors the luminaire.
  Eigen::Matrix3d orientation = Eigen::Matrix3d::Identity();
  std::shared_ptr<const IntensityTable> table;  ///< Never null; lights of one kind share it.
  Spectrum intensity_per_candela;               ///< [W/sr] per band for each candela of the table.
  LuminousOpening opening;

  template <class Visit>
  void for_each_value(Visit&& visit) const {
    visit(position);
    for (int axis = 0; axis < 3; ++axis) visit(Vec3(orientation.col(axis)));
    visit(intensity_per_candela);
    visit(static_cast<std::uint64_t>(table->type()));
    visit(table->polar());
    visit(table->azimuth());
    visit(table->candela());
    visit(static_cast<std::uint64_t>(opening.shape));
    visit(static_cast<std::uint64_t>(opening.axis));
    visit(opening.size());
  }
};

using PunctualLight = std::variant<PointLight, SpotLight, DirectionalLight, PhotometricLight>;

}  // namespace reemit
