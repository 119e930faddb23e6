// [output] functions: which numbers of its modules a run asks for at its end, as "structure.frequency(1);
// structure.max_dt()". Text to calls, and what is wrong with it; who asks is the recorder.
#pragma once

#include <mullion/app/case_file.hpp>

#include <string>
#include <vector>

namespace mullion::config {

struct FunctionCalls {
  std::vector<FunctionCall> calls;
  std::string complaint; ///< what is wrong with the text; "": nothing, and then there are all calls
};

/// Calls with ';' between them, each instance.function(number, …); "" has none. Whether there is such a function is not
/// looked at.
[[nodiscard]] FunctionCalls parse_function_calls(const std::string& text);

} // namespace mullion::config
