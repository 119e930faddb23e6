# Write the build id: a hash over the headers that driver and libmullion share, and the compiler.
set(text "${COMPILER}")
foreach(header ${HEADERS})
  file(SHA256 ${header} hash)
  string(APPEND text ${hash})
endforeach()
string(SHA256 id "${text}")
string(SUBSTRING ${id} 0 16 id)
file(WRITE ${OUT} "// Generated: the build id that drivers and libmullion must share.\n#pragma once\n#define MULLION_BUILD_ID \"${id}\"\n")
