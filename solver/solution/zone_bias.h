#pragma once

namespace reemit {

/// What the discretisation into zones does to light that is read off them: a relative error that is no noise,
/// so that neither packets nor rays lessen it, only smaller zones.
struct ZoneBias {
  double rms = 0;    ///< Best estimate, a fraction >= 0, worst band.
  double bound = 0;  ///< The true one is below this with odds of about 97.5 %; >= rms.

  /// True if it stands out from the noise of its own estimate: its square by 2.5 standard errors, of which
  /// two lie between it and the bound.
  bool certain() const { return bound * bound < 1.8 * rms * rms; }
};

}  // namespace reemit
