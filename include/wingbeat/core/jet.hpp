// ceres::Jet as a scalar: exact first derivatives. Comparisons look at the value alone.
#pragma once

#include <ceres/jet.h>

#include "wingbeat/core/jet_traits.hpp"
