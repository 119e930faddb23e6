// Tells a study's folder from a run's and has the page made.
#include <mullion/app/report.hpp>

#include "report/page.hpp"

#include <mullion/sdk/error.hpp>

#include <filesystem>
#include <utility>

namespace mullion {

Report write_report(const std::string& folder)
{
  namespace fs = std::filesystem;
  MULLION_REQUIRE(fs::is_directory(folder), Errc::config, "{} is no folder; expected the results of a run or a study",
                  folder);
  const bool is_study = fs::exists(fs::path(folder) / "study.json");
  MULLION_REQUIRE(is_study || fs::exists(fs::path(folder) / "run.json"), Errc::config,
                  "{} holds neither run.json nor study.json; expected the results of a run or a study", folder);
  auto page = is_study ? report::study_page(folder) : report::run_page(folder);
  const auto n_plots = report::write_page(folder, std::move(page));
  return {(fs::path(folder) / "report" / "report.html").string(), n_plots};
}

} // namespace mullion
