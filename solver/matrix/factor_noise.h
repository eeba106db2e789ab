#pragma once
#include <cstddef>
#include <cstdint>

#include "solver/matrix/form_factors.h"

namespace reemit {

/// What the errors of sampled form factors do to irradiance: row i, column b * replicates + r holds, for
/// radiosity column b [W/m2], the change of the irradiance of zone i in replicate r when every sampled
/// exchange area is moved by a normal deviate with `spread` times its standard error, the same for both
/// directions of a pair. Deviates depend on seed, pair and replicate only.
RowMatrix factor_noise(const FormFactors& factors, const RowMatrix& radiosity, std::size_t replicates,
                       double spread, std::uint64_t seed);

}  // namespace reemit
