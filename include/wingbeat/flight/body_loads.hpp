// What wings do to the body that carries them; model.md section 18.
#pragma once

#include "wingbeat/parts/body.hpp"
#include "wingbeat/vehicle/dynamics.hpp"

namespace wingbeat {

/// Force and moment about the centre of mass of the air on all wings of a vehicle that has a flow, in body axes, at an
/// instant at which `m` acts in `mode`. Of wings under the pitch law without added mass, of those on hinges with it.
/// The wings are without mass here: what acts on them acts on the body.
BodyLoads wing_loads_on_body(const Vehicle<double>& v, const FullState<double>& instant, const PitchMotion<double>& m,
                             const Mode<double>& mode);

}  // namespace wingbeat
