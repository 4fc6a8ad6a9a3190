# Cross-compilation of the core for 64-bit ARM under Debian (g++-aarch64-linux-gnu, tests under qemu-user). Headers come
# from a folder with links to the host's, since /usr/include itself would bring the host's own C library:
#   mkdir headers && ln -s /usr/include/{eigen3/Eigen,ceres,xsimd} headers/
#   cmake -S . -B build/aarch64 -DCMAKE_TOOLCHAIN_FILE=cmake/aarch64-linux-gnu.cmake -DWINGBEAT_LIBRARY=OFF
#     -DCERES_INCLUDE=$PWD/headers -DXSIMD_INCLUDE=$PWD/headers
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static -L /usr/aarch64-linux-gnu)
