#pragma once
#include <optional>

#include "scenes/model/stop_token.h"
#include "solver/room/room.h"
#include "solver/solution/solution.h"

namespace reemit {

/// How far the radiosity at points lies from that of the zones they are in: the square root of the
/// area means of (B(x) - B_z)^2 over B_z^2, reflected parts, worst band. B(x) is gathered, so it sees shadow
/// edges and gradients inside a zone, which the standard error of the zone values knows nothing of; it is
/// also the error of a picture that shows the zones themselves. Noise of gathers and zones is taken out: two
/// independent halves of the batches give two differences, whose product has no noise on the mean. Where
/// noise leaves it uncertain by more than a factor of two, it is what the difference stays below if that is
/// at most 3 %, else nothing. Takes about 160 rays for each probe. Nothing either with fewer than two
/// batches, without light, with light that gathers miss (RadianceField::has_light_that_rays_miss), or when
/// `stop` is requested before the end.
std::optional<double> discretisation_error(const Room& room, const Solution& solution, const StopToken& stop,
                                           std::size_t probe_count = 1024);

}  // namespace reemit
