# The kernels of the renderer's CUDA backend, as PTX, which the driver of the device compiles when it is first used.
# clang makes it without a CUDA toolkit; nvcc has its own optimizer.
set(GALACTIC_CUDA_COMPILER auto CACHE STRING
  "What compiles the CUDA kernels: clang, nvcc, auto (clang if it is found, otherwise nvcc), or none")
set_property(CACHE GALACTIC_CUDA_COMPILER PROPERTY STRINGS auto clang nvcc none)
find_program(GALACTIC_CUDA_CLANG NAMES clang++-14 clang++)
find_program(GALACTIC_CUDA_NVCC NAMES nvcc PATHS /usr/local/cuda/bin)
mark_as_advanced(GALACTIC_CUDA_CLANG GALACTIC_CUDA_NVCC)

# Sets RESULT to clang, nvcc or, where the library is built without kernels, none.
function(galactic_cuda_compiler result)
  set(found none)
  if(GALACTIC_CUDA_COMPILER STREQUAL "auto")
    if(GALACTIC_CUDA_CLANG)
      set(found clang)
    elseif(GALACTIC_CUDA_NVCC)
      set(found nvcc)
    endif()
  elseif(GALACTIC_CUDA_COMPILER MATCHES "^(clang|nvcc)$")
    string(TOUPPER ${GALACTIC_CUDA_COMPILER} name)
    if(NOT GALACTIC_CUDA_${name})
      message(FATAL_ERROR "GALACTIC_CUDA_COMPILER is ${GALACTIC_CUDA_COMPILER}, which was not found; "
        "install it, set GALACTIC_CUDA_${name} to its path, or choose another compiler")
    endif()
    set(found ${GALACTIC_CUDA_COMPILER})
  elseif(NOT GALACTIC_CUDA_COMPILER STREQUAL "none")
    message(FATAL_ERROR
      "found GALACTIC_CUDA_COMPILER=${GALACTIC_CUDA_COMPILER}, expected auto, clang, nvcc or none")
  endif()
  set(${result} ${found} PARENT_SCOPE)
endfunction()

# Adds the command by which COMPILER makes FOLDER/device.ptx. Floats are rounded as on the processor: nothing is fused,
# and divisions are exact. The oldest devices: compute capability 7.0 for clang 14, 7.5 for nvcc of CUDA 13.
function(galactic_compile_kernels compiler folder)
  set(source ${PROJECT_SOURCE_DIR}/runtime/src/render/cuda/kernels/device.cu)
  set(includes -I ${PROJECT_SOURCE_DIR}/runtime/include -I ${PROJECT_SOURCE_DIR}/runtime/src)
  if(compiler STREQUAL "clang")
    set(command ${GALACTIC_CUDA_CLANG} -x cuda --cuda-device-only -nocudainc -nocudalib --cuda-gpu-arch=sm_70
      -Wno-unknown-cuda-version -std=c++20 -S -O3 -ffp-contract=off -Wall -Wextra -Werror)
  else()
    # Positions, vectors and matrices of the library are constexpr. 1675: GCC's pragmas.
    set(command ${GALACTIC_CUDA_NVCC} -ptx -arch=compute_75 -std=c++20 -O3 -fmad=false -prec-div=true -prec-sqrt=true
      -ftz=false --expt-relaxed-constexpr -diag-suppress 1675 -Werror all-warnings)
  endif()
  file(MAKE_DIRECTORY ${folder})
  add_custom_command(OUTPUT ${folder}/device.ptx
    COMMAND ${command} ${includes} -MD -MF ${folder}/device.d -MT ${folder}/device.ptx ${source} -o ${folder}/device.ptx
    DEPENDS ${source} DEPFILE ${folder}/device.d
    COMMENT "Compiling the CUDA kernels to PTX (${compiler})" VERBATIM)
endfunction()
