# Seconds that long tests take, rounded: ctest starts them first, so that none of them runs alone at the end. First of all
# comes what others wait for.
foreach(cost
    reproduced=1000 explorer.page=300 fmu.Sources=130 docs.quotes=80 manual.Schema=80 cli.Reproduce=50
    study.BenchFit.DirectDriveDeterminesItsPitchHinges=30
    reproduction.Claims=25 docs.tutorials=70 cli.Endurance.TheLongestFlightOnTwoCells=20 study.PitchGradient.OfCranks=20
    fmu.Importers=20 fmu.Numbers=20 fmu.Descriptions=20 python.test_interrupts=15 python.notebooks=15 python.install=15
    python.types=15 study.PitchGradient.AgreesWithDifferences=10 study.Bridge.SeveralMotorsAndAWarmMotor=10
    cli.Figures.OptimaAndTolerance=10 cli.Figures.Sweeps=10 cli.Figures.Fits=10 cli.Pitch.CrankWaveformsAndTargets=10
    python.stubtest=10 python.test_plot=10 examples.mujoco=15
    ensemble.PitchCrankFlapping.OrbitAgreesWithTheSimulationOfRandomVehicles=10
    study.Allocation.SlopesAreThoseOfCyclesBesideTheOperatingPoint=10)
  string(REPLACE "=" ";" cost ${cost})
  list(GET cost 0 name)
  list(GET cost 1 seconds)
  if(DEFINED PROJECT_NAME)  # CMake, for add_test(); ctest does not know it
    if(NOT TEST ${name})
      continue()
    endif()
  endif()
  set_tests_properties(${name} PROPERTIES COST ${seconds})
endforeach()
