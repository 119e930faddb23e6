// A solver that costs next to nothing: reads every value that it receives, writes every value that it owns. What a
// coupled step then costs is the framework (and the memory).
#pragma once

#include <mullion/sdk/plugin.hpp>

namespace mullion::bench {

/// Reads `in` (3 x nodes) of its one window, writes `out` = 0.5 in + 1.
class Echo : public Module {
public:
  struct Options {
    int nodes = 1000;
    static constexpr auto table()
    {
      return std::tuple{parameter("nodes", &Options::nodes, "1", "number of points", at_least(1))};
    }
  };
  Echo(const Options& options, const char* window, const char* out, const char* in)
      : options_(options), window_(window), out_name_(out), in_name_(in)
  {
  }

  void define(const TimeStep&) override
  {
    make_window(window_, {point_pane(Coordinates::Zero(3, options_.nodes))});
    field(window_, out_name_).now().setZero();
  }
  void attach() override
  {
    out_ = field(window_, out_name_);
    in_ = input(window_, in_name_);
  }
  void step(const TimeStep&) override
  {
    const auto in = flat(in_.newest());
    const auto out = flat(out_.now());
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = 0.5 * in[k] + 1.0;
  }

private:
  Options options_;
  const char *window_, *out_name_, *in_name_;
  Field out_;
  Input in_;
};

} // namespace mullion::bench
