#pragma once
#include "scenes/model/interrupted.h"
