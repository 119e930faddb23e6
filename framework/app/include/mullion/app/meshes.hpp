// Look at the meshes of a case before it is run: what `mullion mesh` does, for the command line and bindings.
#pragma once

#include <mullion/app/case_file.hpp>

#include <string>
#include <vector>

namespace mullion {

struct MeshOptions {
  std::string case_file;
  CaseOptions case_options;
  std::string out; ///< folder; "" is out/<run name>-mesh
  std::string log_level = "warning";
};

struct MeshOutcome {
  std::vector<Diagnostic> diagnostics; ///< not empty: the case is wrong, nothing was done
  int exit_code = 0; ///< 0 done; else a message was printed: 1 a module failed or a file cannot be written, 2 the case
                     ///< or the folder is wrong
  std::string summary; ///< what stands in meshes.txt, if all is well
};

/// Have the modules make their windows, inline and under a guard process, do no step, and write what there is: the
/// windows' meshes and first fields as the results of step 0 (results.xdmf), a mesh file INSTANCE.msh for each module
/// that has the function `write_mesh`, and a summary, meshes.txt. Messages go to standard error.
/// @throws Error Errc::config: the log level; Errc::io: the summary cannot be read back
MeshOutcome write_meshes(const MeshOptions& options);

} // namespace mullion
