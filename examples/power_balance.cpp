// How does my own vehicle flap, where does its power go, and which part limits its lift?
#include <cstdio>
#include <exception>
#include <string>
#include <utility>

#include "wingbeat/wingbeat.hpp"

int main() try {
  using namespace wingbeat;
  // The keys of a vehicle file, with units as on data sheets and drawings.
  const std::string own[] = {"supply.type=constant",
                             "supply.voltage=3.7 V",
                             "motor.gear_ratio=20",
                             "motor.gear_efficiency=0.8",
                             "motor.armature_resistance=2.1 ohm",
                             "motor.armature_inductance=60 uH",
                             "motor.torque_constant=1.6 mN m/A",
                             "motor.inertia=0.2 g cm2",
                             "motor.viscous_damping=5e-9 N m s/rad",
                             "transmission.type=slider-crank",
                             "transmission.crank_radius=6 mm",
                             "transmission.rod_length=22 mm",
                             "transmission.stroke_amplitude=40 deg",
                             "transmission.formulation=virtual-work",
                             "friction.type=load-proportional",
                             "friction.radius=0.5 mm",
                             "wing.count=2",
                             "wing.inertia=1.5e-7 kg m2",
                             "wing.planform.shape=semi-ellipse",
                             "wing.planform.length=80 mm",
                             "wing.planform.root_chord=32 mm",
                             "aerodynamics.air_density=1.2 kg/m3",
                             "aerodynamics.pitch_coefficient=8 ms",
                             "aerodynamics.coefficients=translational-2022"};
  const Design<double> design = design_with(own);

  const RunResult found = solve(design);
  std::printf("%s\n", describe(found).c_str());
  if (found.status != FlappingStatus::flapping) return 3;
  if (found.domain.any()) std::printf("outside the domain: %s\n", describe(found.domain_evidence).c_str());

  const EnergyAudit balance = energy_audit(found.metrics);
  const std::pair<const char*, double> rows[] = {{"copper", balance.copper},   {"viscous", balance.viscous},
                                                 {"gearbox", balance.gear},    {"friction", balance.friction},
                                                 {"air", balance.aerodynamic}, {"not conserved", balance.residual}};
  std::printf("mean lift %.1f mN on %.0f mW:\n", 1e3 * found.metrics[Metric::lift_mean], 1e3 * balance.electrical);
  for (const auto& [part, power] : rows) {
    std::printf("  %-14s %7.1f mW %6.2f %%\n", part, 1e3 * power, 100.0 * power / balance.electrical);
  }

  const std::pair<std::string, double> parts[] = {
      {"supply.voltage", design.supply.voltage},
      {"motor.armature_resistance", design.motor.constants.armature_resistance},
      {"motor.gear_ratio", design.motor.gear_ratio.value()},
      {"transmission.crank_radius", design.transmission.crank_radius},
      {"friction.radius", design.friction.coefficient},
      {"wing.inertia", design.wing.inertia}};
  for (const auto& [key, value] : parts) {
    const DesignPoint point = gradient(design, {key});
    const auto share = [&](Metric m) { return value * point.gradients[0][std::size_t(m)] / point.metrics[m]; };
    std::printf("1 %% more %-26s lift %+.2f %%, power %+.2f %%\n", (key + ":").c_str(), share(Metric::lift_mean),
                share(Metric::power_electrical));
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 2;
}
