#pragma once
#include "scenes/model/photometry.h"

namespace reemit {

/// The luminous opening of an LM-63 file: three sizes whose signs say what it is (table of shapes in
/// docs/ies.md). `metres` per unit of length. The editions up to 1995 and from 2002 on differ where width,
/// length and height are -, +, - or +, -, - (ellipsoid, then horizontal cylinder) and -, 0, - (sphere, then
/// upright disk). Sets `known` to false if the signs mean nothing; the opening is then a box of these sizes.
LuminousOpening ies_opening(double width, double length, double height, double metres, bool before_2002,
                            bool& known);

}  // namespace reemit
