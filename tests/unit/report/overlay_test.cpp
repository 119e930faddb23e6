// Histories of a study's runs over one another: which curves go into which picture, and what is drawn of them.
#include "report/overlay.hpp"

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>
#include <variant>
#include <vector>

using namespace mullion;
using namespace mullion::report;

namespace {

namespace fs = std::filesystem;

/// Two lengths times two schemes; run 3 left no history.
struct StudyFolder {
  fs::path path = fs::temp_directory_path() / ("mullion-overlay-" + std::to_string(::getpid()));

  StudyFolder()
  {
    for (int run = 0; run < 3; ++run) {
      fs::create_directories(path / "runs" / std::to_string(run));
      std::ofstream history(path / "runs" / std::to_string(run) / "history.csv");
      history << "step,time,a,b\n";
      for (int i = 0; i <= 4; ++i) history << i << ',' << 0.5 * i << ',' << (run + 1) * i << ',' << 2 << '\n';
    }
  }
  ~StudyFolder() { fs::remove_all(path); }
};

const std::string table_text = "index,length,scheme,outcome\n0,1,CSS,completed\n1,1,GSS,completed\n2,2,CSS,completed\n"
                               "3,2,GSS,failed\n";

std::vector<Plot> pictures(const StudyFolder& folder, nlohmann::json plot)
{
  const nlohmann::json usual = {{"title", "A"},   {"factors", {"a"}}, {"curves", "scheme"}, {"x_scale", 1.0},
                                {"x_label", "t"}, {"y_scale", 1.0},   {"y_label", "a"},     {"from", 0.0},
                                {"to", 0.0},      {"until", 0.0},     {"normalise", "none"}};
  auto whole = usual;
  whole.update(plot);
  const auto table = parse_csv(table_text, "study.csv", LastLine::whole);
  Page page;
  add_overlay(page, folder.path, whole, table, {table.find("length"), table.find("scheme")}, 1);
  std::vector<Plot> plots;
  for (const auto& piece : page.pieces)
    if (const auto* drawn = std::get_if<Figure>(&piece)) plots.push_back(std::get<Plot>(*drawn));
  return plots;
}

} // namespace

TEST_CASE("one picture for each combination of the other axes, a curve for each run of it")
{
  const StudyFolder folder;

  const auto plots = pictures(folder, nlohmann::json::object());

  REQUIRE(plots.size() == 2);
  REQUIRE(plots[0].curves.size() == 2);
  CHECK(plots[0].title == "A, length = 1");
  CHECK(plots[0].curves[0].title == "CSS");
  CHECK(plots[0].curves[1].title == "GSS");
  CHECK(plots[0].curves[1].y == std::vector<double>{0, 2, 4, 6, 8});
  REQUIRE(plots[1].curves.size() == 1);
  CHECK(plots[1].caption.find("GSS has no history") != std::string::npos);
}

TEST_CASE("what is drawn is a product, scaled, cut and normalised as told")
{
  const StudyFolder folder;

  const auto product = pictures(folder, {{"factors", {"a", "b"}}, {"y_scale", 10.0}, {"x_scale", 4.0}})[0].curves[0];
  CHECK(product.x == std::vector<double>{0, 2, 4, 6, 8});
  CHECK(product.y == std::vector<double>{0, 20, 40, 60, 80});

  const auto cut = pictures(folder, {{"from", 0.5}, {"to", 1.5}})[0].curves[0];
  CHECK(cut.x == std::vector<double>{0.5, 1, 1.5});

  CHECK(pictures(folder, {{"normalise", "largest"}})[0].curves[1].y.back() == 1.0);
  CHECK(pictures(folder, {{"normalise", "largest"}, {"until", 1.0}})[0].curves[1].y.back() == 2.0);
  CHECK(pictures(folder, {{"normalise", "first_row"}})[0].curves[1].y.back() == 4.0);
}
