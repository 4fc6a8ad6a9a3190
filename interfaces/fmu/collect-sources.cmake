# cmake -P: the sources of the FMU binary with every header that they need beyond the standard library, as a ZIP file
# whose files find each other: gcc -I. all.cpp. Of COMPILER, FILES (.cpp below ROOT/src), ROOT, the folders EIGEN, CERES
# and XSIMD that hold Eigen, ceres and xsimd, README, FOLDER to work in, and DEPFILE makes OUTPUT. What the compiler
# here does not read is what another processor's, or the same with other options, may: Eigen and xsimd have headers for
# each instruction set, and all of those are packed.

file(REMOVE_RECURSE ${FOLDER})
file(MAKE_DIRECTORY ${FOLDER})
set(all "// Everything in one translation unit.\n")
foreach(file ${FILES})
  file(RELATIVE_PATH name ${ROOT}/src ${file})
  string(APPEND all "#include \"${name}\"\n")
endforeach()
file(WRITE ${FOLDER}/all.cpp "${all}")
execute_process(
  COMMAND ${COMPILER} -std=c++20 -I${ROOT}/include -I${ROOT}/src -I${EIGEN} -I${CERES} -I${XSIMD}
    -M -MT ${OUTPUT} ${FOLDER}/all.cpp
  OUTPUT_VARIABLE needed COMMAND_ERROR_IS_FATAL ANY)
file(WRITE ${DEPFILE} "${needed}")
string(REPLACE "\\\n" " " needed "${needed}")
separate_arguments(needed UNIX_COMMAND "${needed}")
file(GLOB_RECURSE instruction_sets ${EIGEN}/Eigen/src/Core/arch/*.h ${XSIMD}/xsimd/*.hpp)
list(FILTER instruction_sets EXCLUDE REGEX "/arch/(CUDA|GPU|HIP|SYCL)/")
list(APPEND needed ${instruction_sets})
list(REMOVE_DUPLICATES needed)
foreach(file ${needed})
  foreach(place ${ROOT}/include ${ROOT}/src ${EIGEN}/Eigen ${CERES}/ceres ${XSIMD}/xsimd)
    string(FIND ${file} ${place}/ at)
    if(NOT at EQUAL 0)
      continue()
    endif()
    string(REGEX REPLACE "/(Eigen|ceres|xsimd)$" "" top ${place})
    file(RELATIVE_PATH name ${top} ${file})
    get_filename_component(folder ${FOLDER}/${name} DIRECTORY)
    file(COPY ${file} DESTINATION ${folder} FOLLOW_SYMLINK_CHAIN)
    break()
  endforeach()
endforeach()
file(COPY ${README} ${ROOT}/LICENSE DESTINATION ${FOLDER})
file(GLOB entries RELATIVE ${FOLDER} ${FOLDER}/*)
list(SORT entries)
execute_process(COMMAND ${CMAKE_COMMAND} -E tar cf ${OUTPUT} --format=zip --mtime=1980-01-02 -- ${entries}
  WORKING_DIRECTORY ${FOLDER} COMMAND_ERROR_IS_FATAL ANY)
