// Ask a live run something and get its answer as JSON, or its refusal as an Error: the client's side of
// run/commands.hpp.
#pragma once

#include "process/run_socket.hpp"

#include <mullion/sdk/error.hpp>

#include <nlohmann/json.hpp>

#include <string>

namespace mullion::process {

/// @throws Error as ask_run() does; with the run's own code and text if it refuses
inline nlohmann::json ask(const std::string& run, const std::string& line,
                          std::chrono::seconds patience = std::chrono::seconds(5))
{
  const auto text = ask_run(run, line, patience);
  const auto reply = nlohmann::json::parse(text, nullptr, false);
  MULLION_REQUIRE(reply.is_object(), Errc::process, "run '{}' answered: {}", run, text);
  if (const auto error = reply.find("error"); error != reply.end())
    throw Error(static_cast<Errc>(reply.value("code", static_cast<int>(Errc::process))), error->get<std::string>());
  return reply;
}

} // namespace mullion::process
