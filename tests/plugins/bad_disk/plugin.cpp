// Breaks the rule: a file on disk counts the steps and feeds the result. It outlives every process.
#include "../one_point_structure.hpp"

#include <mullion/sdk/plugin.hpp>

#include <fstream>
#include <string>

namespace mullion::test {

class BadDisk final : public OnePointStructure {
public:
  struct Options {
    std::string path;
    static constexpr auto table()
    {
      return std::tuple{required_parameter("path", &Options::path, "", "of the file that counts")};
    }
  };
  explicit BadDisk(const Options& options) : path_(options.path) {}

protected:
  double kept_elsewhere(const TimeStep&, double) override
  {
    int n_steps = 0;
    std::ifstream(path_) >> n_steps;
    std::ofstream(path_) << ++n_steps;
    return 1e-3 * n_steps;
  }

private:
  std::string path_;
};

} // namespace mullion::test

MULLION_PLUGIN(mullion::test::BadDisk, "structure", "bad_disk", "test structure with state in a file on disk");
