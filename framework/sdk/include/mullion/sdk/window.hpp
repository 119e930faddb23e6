// A module's view of its windows: handles that are found once in `attach` and give Eigen views, (components x
// entities), during each call. Level 0 is the working level; 1, 2, … are the committed levels behind it, newest
// first, and const. A view is valid during one call only: never keep one in a member.
#pragma once

#include <mullion/sdk/abi.h>
#include <mullion/sdk/error.hpp>
#include <mullion/sdk/field.hpp>
#include <mullion/sdk/mesh.hpp>

#include <Eigen/Core>

#include <cmath>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mullion {

using Array = Eigen::Map<Eigen::MatrixXd, Eigen::Aligned64>; ///< (components x entities), one a column
using ConstArray = Eigen::Map<const Eigen::MatrixXd, Eigen::Aligned64>;
using ConstIndexArray = Eigen::Map<const Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic>, Eigen::Aligned64>;
using IndexArray = Eigen::Map<Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic>, Eigen::Aligned64>;

/// All entries of an array, component after component, entity after entity.
inline std::span<double> flat(Array array) { return {array.data(), static_cast<std::size_t>(array.size())}; }
inline std::span<const double> flat(ConstArray array) { return {array.data(), static_cast<std::size_t>(array.size())}; }

/// The coupling step that a call belongs to. The times are computed once by Mullion; nobody recomputes them.
struct TimeStep {
  std::int64_t index = 0;    ///< 1 for the first step, 0 in define and start
  double begin = 0, end = 0; ///< [s]
  double dt = 0;             ///< [s] the same bits in every step but a shortened one, unlike end - begin
  int iteration = 0;         ///< of a step that is iterated; 0 for the first
};

/// The services of the C boundary with failures turned into exceptions. One per module instance.
class Services {
public:
  Services(const mullion_services* services, void* context) : services_(services), context_(context) {}

  void require(std::int32_t status) const
  {
    if (status != MULLION_OK) throw Error(static_cast<Errc>(status), services_->error_text(context_));
  }
  [[nodiscard]] const mullion_services* raw() const { return services_; }
  [[nodiscard]] void* context() const { return context_; }

private:
  const mullion_services* services_;
  void* context_;
};

/// One field of one pane of the module's own windows.
class Field {
public:
  Field() = default;
  Field(const Services* services, std::uint32_t handle) : services_(services), handle_(handle) {}

  /// The working level; writable in step (state, output) and in define (everything).
  [[nodiscard]] Array now() const
  {
    const auto raw = view(0);
    MULLION_ASSERT(raw.is_writable && raw.scalar == MULLION_F64, "this field is read-only here");
    return {static_cast<double*>(raw.data), raw.components, raw.entities};
  }
  /// The values of a fixed field, or of the working level when it is only read.
  [[nodiscard]] ConstArray values() const
  {
    const auto raw = view(0);
    return {static_cast<const double*>(raw.data), raw.components, raw.entities};
  }
  /// The last committed level (back = 1) and those before it.
  [[nodiscard]] ConstArray committed(int back = 1) const
  {
    const auto raw = view(back);
    return {static_cast<const double*>(raw.data), raw.components, raw.entities};
  }
  [[nodiscard]] IndexArray index_now() const
  {
    const auto raw = view(0);
    MULLION_ASSERT(raw.is_writable && raw.scalar == MULLION_I32, "not a writable integer field");
    return {static_cast<Index*>(raw.data), raw.components, raw.entities};
  }
  [[nodiscard]] ConstIndexArray indices() const
  {
    const auto raw = view(0);
    MULLION_ASSERT(raw.scalar == MULLION_I32, "not an integer field");
    return {static_cast<const Index*>(raw.data), raw.components, raw.entities};
  }

private:
  [[nodiscard]] mullion_array view(int level) const
  {
    MULLION_ASSERT(services_ != nullptr, "a field was used that attach() never looked up");
    mullion_array raw{};
    services_->require(services_->raw()->view(services_->context(), handle_, level, &raw));
    return raw;
  }
  const Services* services_ = nullptr;
  std::uint32_t handle_ = 0;
};

/// One field that the module receives. The driver decides when it is written and how it varies within a step.
class Input {
public:
  Input() = default;
  Input(const Services* services, std::uint32_t handle) : services_(services), handle_(handle) {}

  /// False if the driver left this (optional) field out: use the module's default.
  [[nodiscard]] bool is_connected() const { return services_ != nullptr && handle_ != MULLION_UNCONNECTED; }

  /// The newest value, whatever time it is stamped with.
  [[nodiscard]] ConstArray newest() const
  {
    const auto raw = received();
    return {raw.data[0], raw.components, raw.entities};
  }

  /// Does the newest value stand for the mean over the step (rather than for the step's end)?
  [[nodiscard]] bool is_mean() const { return received().stamps[0].kind == MULLION_MEAN; }

  /// The value at time t [s] by the driver's policy: constant, or interpolated between the stamped levels.
  /// At a stamped time it is that level to the bit; in between it lies in storage of this object and is valid
  /// until the next at(). Times within 1e-9 of the newest interval beyond its ends count as the ends.
  /// @throws Error Errc::shape outside the stamped levels, unless the policy is constant
  [[nodiscard]] ConstArray at(double t)
  {
    const auto raw = received();
    const auto level = [&](std::uint32_t k) { return ConstArray(raw.data[k], raw.components, raw.entities); };
    if (raw.policy == MULLION_CONSTANT || raw.n_levels < 2) return level(0);
    const double newest = raw.stamps[0].time, before = raw.stamps[1].time;
    const double tolerance = 1e-9 * std::abs(newest - before);
    for (std::uint32_t k = 0; k < raw.n_levels; ++k)
      if (std::abs(t - raw.stamps[k].time) <= tolerance) return level(k);
    const auto oldest = raw.stamps[raw.n_levels - 1].time;
    MULLION_REQUIRE(oldest < t && t < newest, Errc::shape,
                    "a received field was read at t = {} s, outside its stamped levels [{}, {}] s; only the "
                    "constant policy allows that",
                    t, oldest, newest);
    std::uint32_t k = 0; // t lies between the levels k + 1 and k
    while (t < raw.stamps[k + 1].time) ++k;
    scratch_.resize(raw.components, raw.entities);
    if (raw.policy == MULLION_QUADRATIC && raw.n_levels >= 3) {
      if (k + 2 >= raw.n_levels) k = raw.n_levels - 3;
      const double a = raw.stamps[k].time, b = raw.stamps[k + 1].time, c = raw.stamps[k + 2].time;
      scratch_ = ((t - b) * (t - c) / ((a - b) * (a - c))) * level(k) +
                 ((t - a) * (t - c) / ((b - a) * (b - c))) * level(k + 1) +
                 ((t - a) * (t - b) / ((c - a) * (c - b))) * level(k + 2);
    } else {
      const double s = (t - raw.stamps[k + 1].time) / (raw.stamps[k].time - raw.stamps[k + 1].time);
      scratch_ = (1.0 - s) * level(k + 1) + s * level(k);
    }
    return {scratch_.data(), raw.components, raw.entities};
  }

private:
  [[nodiscard]] mullion_received received() const
  {
    MULLION_ASSERT(is_connected(), "an unconnected input was read; ask is_connected() first");
    mullion_received raw{};
    services_->require(services_->raw()->received(services_->context(), handle_, &raw));
    return raw;
  }
  const Services* services_ = nullptr;
  std::uint32_t handle_ = MULLION_UNCONNECTED;
  class Scratch { // 64-byte aligned, so that sums over it have the bits of sums over a window
  public:
    void resize(Eigen::Index rows, Eigen::Index cols)
    {
      if (rows == rows_ && cols == cols_) return;
      storage_.assign(static_cast<std::size_t>(rows * cols) + 8, 0.0);
      rows_ = rows;
      cols_ = cols;
    }
    double* data()
    {
      const auto address = reinterpret_cast<std::uintptr_t>(storage_.data());
      return reinterpret_cast<double*>((address + 63) & ~std::uintptr_t{63});
    }
    template <class Expression> Scratch& operator=(const Expression& expression)
    {
      Array(data(), rows_, cols_) = expression;
      return *this;
    }

  private:
    std::vector<double> storage_;
    Eigen::Index rows_ = 0, cols_ = 0;
  };
  Scratch scratch_;
};

} // namespace mullion
