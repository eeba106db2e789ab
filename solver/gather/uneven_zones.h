#pragma once
#include <cstdint>
#include <vector>

#include "scenes/model/stop_token.h"
#include "solver/gather/direct_light.h"
#include "solver/gather/radiance_field.h"

namespace reemit {

/// By zone, 1 where one value for the whole zone misleads a gather ray that sees a part of it. Of two kinds:
/// - Direct light inside the zone varies by more than the room's mean reflected radiance, or is many times
///   that mean. Such zones lie beside lamps and on the edges of bright spots; what hides them partly (the
///   lamp itself) hides their bright or their dark part.
/// - A part of the zone is hidden from the room and darker or brighter than the rest (SeenLight).
/// Found with rays of its own: the choice does not follow the noise of the zones, so that continuing gather
/// rays there favours no side. The zones with the largest differences come first where they would make up
/// more than a fifth of the area. Four shadow rays and four others per zone; 8 and 16 more where those of
/// zones that follow each other leave a doubt, ten times that for candidates. The same for any number of
/// threads. When `stop` (may be null) is requested it returns early, and what it returns means nothing.
std::vector<std::uint8_t> uneven_zones(const RadianceField& field, const DirectLight& direct,
                                       std::uint64_t seed, const StopToken* stop = nullptr);

}  // namespace reemit
