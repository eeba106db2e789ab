#pragma once
#include "scenes/model/stop_token.h"
#include "viewer_export/still/still_image.h"

namespace reemit {

/// Takes the grain out of a finished still: every pixel becomes a mean over the pixels around it that are the
/// same within their noise, by non-local means with two buffers ([RKZ12] sec. 4): what one half is averaged
/// over was chosen by the other half, so noise does not choose what it likes. A narrow first smoothing tells
/// what is alike ([DFKE07]: basic estimate). Irradiance is averaged, not radiance: the reflectance of what is
/// seen, and so every texture, stays as it is. Edges of normal and depth are not crossed. What noise photons
/// leave beyond that is taken out by smooth_coarsely. Layers of direct, indirect and caustic light are
/// averaged alike and still add up. The standard error is that of the means, as the smoothed halves show it
/// of all pixels together that are averaged alike: noise that neighbours share (of the zone solution) makes
/// it larger, samples that fill each other's gaps make it smaller. Where blocks of 16 x 16 pixels show that
/// the means are off by more than noise explains, that is added. Their rms is image.info.error afterwards.
/// `error_floor`: as of StillSettings. Leaves a picture without standard errors as it is, and any once `stop`
/// is requested. Runs in the arena of the caller, the same bits on any number of threads. Throws
/// ResourceError when what it needs does not fit into memory.
void smooth_still(StillImage& image, const StillHalves& halves, double error_floor, const StopToken& stop);

}  // namespace reemit
