# How everything of Mullion is compiled: C++20, no contraction of a*b+c (results must not depend on it), no
# fast-math, hidden symbols, warnings, and the sanitizers of MULLION_SANITIZE.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

add_library(mullion_compile INTERFACE)
target_compile_options(mullion_compile INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow=local -ffp-contract=off -fno-gnu-unique
  -Wno-restrict  # g++ 12 is wrong about std::string in several places
  $<$<BOOL:${MULLION_WERROR}>:-Werror>)
if(MULLION_SANITIZE)
  list(JOIN MULLION_SANITIZE "," sanitizers)
  add_compile_options(-fsanitize=${sanitizers} -fno-omit-frame-pointer -fno-sanitize-recover=undefined -g1)
  add_link_options(-fsanitize=${sanitizers})
  if("address" IN_LIST MULLION_SANITIZE)
    # Each of the two halves compile times. A null pointer's access ends in the address sanitizer's report anyway.
    add_compile_options(-O1 -fno-sanitize=null)
  endif()
endif()
