// What the integrators of SUNDIALS share: the vector of states and the rates.
#pragma once

#include <nvector/nvector_serial.h>

#include "peers/equations.hpp"

namespace wingbeat::peers {

template <std::size_t N>
class SundialsStates {
 public:
  SundialsStates(const SundialsStates&) = delete;
  SundialsStates& operator=(const SundialsStates&) = delete;

 protected:
  SundialsStates() {
    SUNContext_Create(nullptr, &context_);
    y_ = N_VNew_Serial(sunindextype(N), context_);
    N_VConst(1.0, y_);
  }
  ~SundialsStates() {
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }

  // `self` is the object as SundialsStates*; a speed that is not positive asks for a smaller step.
  static int rates(realtype theta, N_Vector y, N_Vector dy, void* self) {
    const double* u = N_VGetArrayPointer(y);
    if (!(u[0] > 0.0)) return 1;
    static_cast<SundialsStates*>(self)->peer_->template rates<N>(theta, u, N_VGetArrayPointer(dy));
    return 0;
  }
  static void say_nothing(int, const char*, const char*, char*, void*) {}

  const Peer* peer_ = nullptr;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
};

}  // namespace wingbeat::peers
