// First states from tables: what is read, and what is said of a table that does not fit.
#include "euler/saved_state.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>
#include <vector>

using namespace mullion::euler;

namespace {

/// A table in a file of its own, and two cells of 1 m^2 beside one another.
class Table {
public:
  explicit Table(const std::string& text)
      : path_((std::filesystem::temp_directory_path() / ("mullion-table-" + std::to_string(::getpid()) + ".csv"))
                  .string())
  {
    std::ofstream(path_) << text;
  }
  ~Table() { std::filesystem::remove(path_); }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;

  [[nodiscard]] std::vector<Values<2>> read() const
  {
    const std::vector<Vec<2>> centroid = {{0.5, 0.5}, {1.5, 0.5}};
    const std::vector<double> volume = {1.0, 1.0};
    return saved_state(path_, Gas{1.4}, Eigen::Matrix2Xd(2, 0), centroid, volume);
  }
  /// What is said of it, without its name.
  [[nodiscard]] std::string error() const
  {
    try {
      static_cast<void>(read());
    } catch (const SavedStateError& error) {
      return std::string(error.what()).substr(path_.size());
    }
    return "no error";
  }

private:
  std::string path_;
};

} // namespace

TEST_CASE("a table of cells is read in any order of columns and lines")
{
  const Table table("x,y,p,u,v,rho,note\n1.5,0.5,2.0,0,0,1,far\n0.5,0.5,1.0,2.0,0,0.5,near\n");

  const auto amounts = table.read();

  CHECK(amounts[0] == Values<2>{0.5, 1.0, 0.0, 1.0 / (1.4 - 1.0) + 0.5 * 0.5 * 4.0});
  CHECK(amounts[1] == Values<2>{1.0, 0.0, 0.0, 2.0 / (1.4 - 1.0)});
}

TEST_CASE("a table that does not fit is refused with the place")
{
  CHECK(Table("x,y,rho,u,v\n").error() == ": no column p in its first line; expected x,y,rho,u,v,p in any order");
  CHECK(Table("x,y,rho,u,v,p\n0.5,0.5,1,0,zero,1\n").error() == ":2: \"zero\" is no number (column v)");
  CHECK(
      Table("x,y,rho,u,v,p\n0.5,0.5,1,0,0,1\n").error() ==
      ": none of its 1 lines is at (1.5, 0.5) m, the centroid of cell 1 of 2, to 1e-06 m; it must be of the same mesh");
  CHECK(Table("x,y,rho,u,v,p\n0.5,0.5,1,0,0,-1\n").error() ==
        ": the density or the pressure at (0.5, 0.5) m is not positive");
}
