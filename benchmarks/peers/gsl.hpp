// The GNU Scientific Library's methods: variable-order Adams in Nordsieck form (msadams), Cash and Karp's fifth order
// (rkck), Prince and Dormand's eighth (rk8pd).
#pragma once

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <algorithm>
#include <array>

#include "peers/equations.hpp"

namespace wingbeat::peers {

template <std::size_t N>
class Gsl {
 public:
  explicit Gsl(const gsl_odeiv2_step_type* method) : system_{&rates, nullptr, N, this} {
    gsl_set_error_handler_off();
    driver_ = gsl_odeiv2_driver_alloc_y_new(&system_, method, first_step, coarse, coarse);
    gsl_odeiv2_driver_set_nmax(driver_, 100000);
  }
  Gsl(const Gsl&) = delete;
  Gsl& operator=(const Gsl&) = delete;
  ~Gsl() { gsl_odeiv2_driver_free(driver_); }

  void begin(const Peer& peer, const double* u, double tolerance) {
    peer_ = &peer;
    gsl_odeiv2_control_init(driver_->c, tolerance, tolerance, 1.0, 0.0);
    gsl_odeiv2_driver_reset_hstart(driver_, first_step);
    std::copy_n(u, N, y_.begin());
    theta_ = begun_ = iterate_start;
    last_.fill(0.0);
  }

  // Goes on without a restart, which would take Adams back to first order; quadratures by difference.
  bool iterate(double* u) {
    begun_ += two_pi;
    if (gsl_odeiv2_driver_apply(driver_, &theta_, begun_, y_.data()) != GSL_SUCCESS) return false;
    for (std::size_t n = 0; n < N; ++n) {
      u[n] = n < 2 ? y_[n] : y_[n] - last_[n];
      last_[n] = y_[n];
    }
    return u[0] > 0.0;
  }

 private:
  static int rates(double theta, const double* u, double* du, void* self) {
    if (!(u[0] > 0.0)) return GSL_FAILURE;
    static_cast<Gsl*>(self)->peer_->template rates<N>(theta, u, du);
    return GSL_SUCCESS;
  }

  const Peer* peer_ = nullptr;
  gsl_odeiv2_system system_;
  gsl_odeiv2_driver* driver_ = nullptr;
  double begun_ = 0.0, theta_ = 0.0;
  std::array<double, N> y_{}, last_{};
};

}  // namespace wingbeat::peers
