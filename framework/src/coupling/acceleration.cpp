#include <mullion/coupling/acceleration.hpp>

#include <mullion/sdk/error.hpp>

#include <algorithm>

namespace mullion {
namespace {

constexpr int reuse_without_jacobian = 8; // IQN-MVJ with too many unknowns for a dense J

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// V = Q R by Gram-Schmidt with re-orthogonalisation, columns in their order; those that bring nothing new are left
/// out.
struct FilteredQr {
  Matrix q, r;
  std::vector<std::size_t> kept;
};

FilteredQr filtered_qr(const std::vector<Vector>& columns, double filter)
{
  FilteredQr qr;
  if (columns.empty()) return qr;
  const auto n = columns[0].size();
  const auto most = std::min<Eigen::Index>(n, static_cast<Eigen::Index>(columns.size()));
  qr.q.resize(n, most);
  qr.r = Matrix::Zero(most, most);
  Eigen::Index m = 0;
  for (std::size_t j = 0; j < columns.size() && m < most; ++j) {
    Vector v = columns[j];
    const double size = v.norm();
    Vector h = Vector::Zero(most);
    for (int pass = 0; pass < 2; ++pass)
      for (Eigen::Index i = 0; i < m; ++i) {
        const double c = qr.q.col(i).dot(v);
        v -= c * qr.q.col(i);
        h(i) += c;
      }
    const double rest = v.norm();
    if (!(size > 0.0) || !(rest >= filter * size)) continue;
    qr.q.col(m) = v / rest;
    qr.r.col(m).head(m) = h.head(m);
    qr.r(m, m) = rest;
    qr.kept.push_back(j);
    ++m;
  }
  qr.q.conservativeResize(n, m);
  qr.r.conservativeResize(m, m);
  return qr;
}

/// R^-1 b for an upper triangle.
Vector solve_upper(const Matrix& r, Vector b)
{
  for (Eigen::Index i = b.size() - 1; i >= 0; --i) {
    for (Eigen::Index j = i + 1; j < b.size(); ++j) b(i) -= r(i, j) * b(j);
    b(i) /= r(i, i);
  }
  return b;
}

} // namespace

template <class Body> void Acceleration::for_each_field(Body&& body) const
{
  Eigen::Index at = 0;
  for (std::size_t p = 0; p < sizes_.size(); at += sizes_[p++]) body(p, at, sizes_[p]);
}

void Acceleration::define(Wiring& wiring, const std::vector<std::string>& ports)
{
  ports_ = ports;
  if (!is_quasi_newton()) return;
  for (std::size_t p = 0; p < ports.size(); ++p) {
    wiring.state_like(fmt::format("residual_changes_{}", p), ports[p], options_.max_columns);
    wiring.state_like(fmt::format("result_changes_{}", p), ports[p], options_.max_columns);
  }
  wiring.state_numbers("column_ages", options_.max_columns);
  wiring.state_numbers("last_dt", 1);
  if (options_.method == "iqn_mvj") wiring.state_square("jacobian", ports, largest_jacobian);
}

void Acceleration::attach(const Coupling& coupling)
{
  if (!is_quasi_newton()) return;
  v_state_.clear(), w_state_.clear(), sizes_.clear();
  n_ = 0;
  for (std::size_t p = 0; p < ports_.size(); ++p) {
    v_state_.push_back(coupling.state(fmt::format("residual_changes_{}", p)));
    w_state_.push_back(coupling.state(fmt::format("result_changes_{}", p)));
    sizes_.push_back(v_state_.back().committed().size() / options_.max_columns);
    n_ += sizes_.back();
  }
  ages_ = coupling.state("column_ages");
  last_dt_ = coupling.state("last_dt");
  if (options_.method != "iqn_mvj") return;
  jacobian_ = coupling.state("jacobian");
  has_jacobian_ = n_ <= largest_jacobian;
  if (!has_jacobian_) options_.reuse = reuse_without_jacobian;
}

// ---- a step ------------------------------------------------------------------------------------------------------

void Acceleration::begin_step(const TimeStep& step)
{
  columns_.clear();
  field_sums_.assign(ports_.size(), 0.0);
  iteration_ = 0;
  theta_ = options_.relaxation;
  if (!is_quasi_newton()) return;
  // Columns approximate the map's derivative at their own step size.
  const double last = last_dt_.committed()(0, 0);
  const bool is_another_size = last > 0.0 && (step.dt > 2.0 * last || step.dt < 0.5 * last);
  is_fresh_ = ages_.committed()(0, 0) == 0.0 || is_another_size; // no column was ever kept, no Jacobian made
  if (is_another_size) {
    ages_.now().setZero();
    if (has_jacobian_) jacobian_.now().setZero();
  } else if (!has_jacobian_) {
    load_columns();
  }
}

Vector Acceleration::next(const Vector& x, const Vector& result)
{
  const Vector residual = result - x;
  const int k = iteration_++;
  Vector next;
  if (options_.method == "constant") {
    next = x + options_.relaxation * residual;
  } else if (options_.method == "aitken") {
    if (k > 0) {
      const Vector change = residual - residual_before_;
      const double size2 = change.squaredNorm();
      if (size2 > 0.0) theta_ = -theta_ * residual_before_.dot(change) / size2;
    }
    next = x + theta_ * residual;
  } else {
    weigh_fields(residual);
    if (k > 0) add_columns(residual, result);
    next = has_jacobian_ ? jacobian_step(residual, result) : least_squares_step(residual, result);
  }
  residual_before_ = residual;
  result_before_ = result;
  return next;
}

void Acceleration::end_step(const TimeStep& step, const Vector& x, const Vector& result)
{
  if (!is_quasi_newton()) return;
  if (iteration_ > 0) add_columns(result - x, result); // the last evaluation is the best one; alone it makes no column
  last_dt_.now()(0, 0) = step.dt;
  if (!has_jacobian_) return store_columns();
  // J = J_prev + (W - J_prev V)(V^T V)^-1 V^T, with V's rows weighted as in the iterations.
  const Vector scale = row_scaling();
  std::vector<Vector> scaled;
  for (const auto& column : columns_) scaled.push_back(column.v.cwiseProduct(scale));
  const auto qr = filtered_qr(scaled, options_.filter);
  const auto m = static_cast<Eigen::Index>(qr.kept.size());
  if (m == 0) return;
  ages_.now()(0, 0) = 1.0; // there is a Jacobian now
  Eigen::Map<Matrix> jacobian(jacobian_.now().data(), n_, n_);
  Matrix w(n_, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const auto& column = columns_[qr.kept[static_cast<std::size_t>(j)]];
    w.col(j) = column.w - jacobian * column.v;
  }
  Matrix inverse(m, n_); // R^-1 Q^T, the pseudo-inverse of the scaled columns
  const Matrix qt = qr.q.transpose();
  for (Eigen::Index i = 0; i < n_; ++i) inverse.col(i) = solve_upper(qr.r, qt.col(i)) * scale(i);
  jacobian += w * inverse;
}

void Acceleration::weigh_fields(const Vector& residual)
{
  // An iteration in which one field has no residual at all says nothing about the fields' relative size: at the very
  // start, from rest, it would drown the smaller field for the whole step.
  std::vector<double> norms;
  for_each_field(
      [&](std::size_t, Eigen::Index at, Eigen::Index n) { norms.push_back(residual.segment(at, n).norm()); });
  if (std::any_of(norms.begin(), norms.end(), [](double norm) { return norm == 0.0; })) return;
  for (std::size_t p = 0; p < norms.size(); ++p) field_sums_[p] += norms[p] / residual.norm();
}

void Acceleration::add_columns(const Vector& residual, const Vector& result)
{
  columns_.insert(columns_.begin(), {residual - residual_before_, result - result_before_, 0});
  if (columns_.size() > static_cast<std::size_t>(options_.max_columns)) columns_.pop_back();
}

Vector Acceleration::row_scaling() const
{
  Vector scale = Vector::Ones(n_);
  if (sizes_.size() < 2) return scale;
  for_each_field([&](std::size_t p, Eigen::Index at, Eigen::Index n) {
    if (field_sums_[p] > 0.0) scale.segment(at, n).setConstant(1.0 / field_sums_[p]);
  });
  return scale;
}

Acceleration::Combination Acceleration::fit_columns(const Vector& residual) const
{
  const Vector scale = row_scaling();
  std::vector<Vector> scaled;
  for (const auto& column : columns_) scaled.push_back(column.v.cwiseProduct(scale));
  auto qr = filtered_qr(scaled, options_.filter);
  if (qr.kept.empty()) return {};
  return {std::move(qr.kept), solve_upper(qr.r, -(qr.q.transpose() * residual.cwiseProduct(scale)))};
}

Vector Acceleration::least_squares_step(const Vector& residual, const Vector& result) const
{
  const auto [kept, c] = fit_columns(residual);
  if (kept.empty()) return result - residual + options_.first_relaxation * residual;
  Vector next = result;
  for (std::size_t j = 0; j < kept.size(); ++j) next += c(static_cast<Eigen::Index>(j)) * columns_[kept[j]].w;
  return next;
}

Vector Acceleration::jacobian_step(const Vector& residual, const Vector& result) const
{
  const Eigen::Map<const Matrix> before(jacobian_.now().data(), n_, n_);
  const auto [kept, c] = fit_columns(residual);
  if (kept.empty() && is_fresh_) return result - residual + options_.first_relaxation * residual;
  Vector next = result - before * residual;
  for (std::size_t j = 0; j < kept.size(); ++j)
    next += c(static_cast<Eigen::Index>(j)) * (columns_[kept[j]].w - before * columns_[kept[j]].v);
  return next;
}

// ---- what survives a step ----------------------------------------------------------------------------------------

void Acceleration::load_columns()
{
  const ConstArray ages = ages_.committed();
  for (Eigen::Index j = 0; j < ages.size(); ++j) {
    const int age = static_cast<int>(ages.data()[j]);
    if (age == 0) break;
    Column column{Vector(n_), Vector(n_), age};
    for_each_field([&](std::size_t p, Eigen::Index at, Eigen::Index n) {
      column.v.segment(at, n) = Eigen::Map<const Vector>(v_state_[p].committed().data() + j * n, n);
      column.w.segment(at, n) = Eigen::Map<const Vector>(w_state_[p].committed().data() + j * n, n);
    });
    columns_.push_back(std::move(column));
  }
}

void Acceleration::store_columns()
{
  ages_.now().setZero();
  Eigen::Index j = 0;
  for (const auto& column : columns_) {
    if (column.age + 1 > options_.reuse || j >= options_.max_columns) continue;
    ages_.now().data()[j] = column.age + 1;
    for_each_field([&](std::size_t p, Eigen::Index at, Eigen::Index n) {
      Eigen::Map<Vector>(v_state_[p].now().data() + j * n, n) = column.v.segment(at, n);
      Eigen::Map<Vector>(w_state_[p].now().data() + j * n, n) = column.w.segment(at, n);
    });
    ++j;
  }
}

} // namespace mullion
