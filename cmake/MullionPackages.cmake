# The libraries that Mullion is built from; packages.txt names the Debian packages that bring them.
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(Threads REQUIRED)
find_package(Boost REQUIRED COMPONENTS program_options)
find_package(HDF5 REQUIRED COMPONENTS C)
find_package(tomlplusplus REQUIRED) # Debian: a compiled library
find_package(nlohmann_json REQUIRED)
find_package(pugixml REQUIRED)   # mesh files
find_package(ZLIB REQUIRED)      # mesh files
find_package(muparser REQUIRED)  # expressions in parameters of modules
find_package(Spectra REQUIRED)   # eigenvalues, for modal analysis
if(MULLION_TESTS)
  find_package(doctest REQUIRED)
endif()
