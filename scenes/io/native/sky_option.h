#pragma once
#include <string>

#include "scenes/model/scene.h"

namespace reemit {

/// Gives a room the sky and the sun of the options --sky and --sun (docs/sky.md), either of which may be
/// empty, in place of those of its file. Throws InputError that names the option.
void add_sky(const std::string& sky, const std::string& sun, Scene& scene);

/// The same text with the file of an image as an absolute path, so that it means the same in other folders.
std::string with_absolute_path(const std::string& sky);

}  // namespace reemit
