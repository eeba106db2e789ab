#pragma once
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

#include "scenes/model/ids.h"

namespace reemit {

/// What meshing may do to a face of the room.
enum class FaceChange : std::uint8_t {
  kFlipped,     ///< Turned round because the rest of its closed shell says so.
  kCovered,     ///< Lost area to a face of its plane.
  kCovers,      ///< Kept a spot that another face of its plane lost, or is the one kept of two alike.
  kDuplicate,   ///< Left out: there is another with the same corners.
  kDegenerate,  ///< Left out, or a part of it: no area, or smaller or thinner than the weld distance.
  kNonPlanar,   ///< Split into triangles.
  kCrossed,     ///< Its outline or holes cross; what they enclose was filled.
  kWelded,      ///< A corner was moved onto another, or is gone.
  kFaceted,     ///< Made of a round shape that other faces pass through.
  kCut,         ///< Cut along the contact with another face.
  kBackToBack,  ///< Shares its place with another face, which has the other side.
};

/// A change of one face: `face` counts in its surface; those made of round shapes come after all as read.
struct ChangedFace {
  SurfaceId surface;
  std::uint32_t face = 0;
  FaceChange change = FaceChange::kFlipped;

  auto operator<=>(const ChangedFace&) const = default;
};

/// Sorts by surface, face and change; what happened to several pieces of a face is there once.
void tidy(std::vector<ChangedFace>& changes);

/// The changes of one face. Pre: tidy.
std::span<const ChangedFace> changes_of(std::span<const ChangedFace> changes, SurfaceId surface,
                                        std::uint32_t face);

}  // namespace reemit
