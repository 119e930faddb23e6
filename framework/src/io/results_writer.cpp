#include "io/results_writer.hpp"

#include "io/hdf5_image.hpp"

#include <mullion/sdk/error.hpp>
#include <mullion/sdk/mesh.hpp>

#include <signal.h>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

namespace mullion::io {
namespace {

namespace fs = std::filesystem;

constexpr auto index_interval = std::chrono::seconds(2); // of wall time between two writings of the indices

constexpr std::array<const char*, 8> element_names{"point1",       "line2",    "triangle3", "quadrilateral4",
                                                   "tetrahedron4", "pyramid5", "prism6",    "hexahedron8"};
/// The numbers of the XDMF specification for elements in a mixed topology.
constexpr std::array<std::int32_t, 8> xdmf_numbers{1, 2, 4, 5, 6, 7, 8, 9};

const char* location_name(std::uint32_t location)
{
  switch (location) {
  case MULLION_NODE: return "node";
  case MULLION_ELEMENT: return "element";
  default: return "pane";
  }
}

void check_pane(const std::string& group, const PaneData& pane)
{
  MULLION_REQUIRE(1 <= pane.dimension && pane.dimension <= 3, Errc::shape,
                  "results: {} has dimension {}, which is not 1, 2 or 3", group, pane.dimension);
  std::int64_t n_elements = 0;
  for (const auto& block : pane.blocks) {
    MULLION_REQUIRE(nodes_per_element(block.element) == block.nodes_per_element && block.nodes_per_element > 0,
                    Errc::shape, "results: {} has a block of elements of type {} with {} nodes each", group,
                    block.element, block.nodes_per_element);
    n_elements += block.n_elements;
  }
  MULLION_REQUIRE(n_elements == pane.n_elements, Errc::shape, "results: {} has {} elements but its blocks {}", group,
                  pane.n_elements, n_elements);
}

std::int64_t expected_entities(const FieldData& field, const PaneData& pane)
{
  switch (field.location) {
  case MULLION_NODE: return pane.n_nodes;
  case MULLION_ELEMENT: return pane.n_elements;
  default: return 1;
  }
}

void write_field(ImageBuilder& image, const std::string& group, const PaneData& pane, const FieldData& field)
{
  const auto path = group + "/" + field.name;
  MULLION_REQUIRE(!field.name.empty() && field.name.find('/') == std::string::npos && field.name != "geometry" &&
                      field.name != "topology" && !field.name.starts_with("connectivity_"),
                  Errc::plugin,
                  "results: {} cannot be written: the name '{}' has a meaning in results files; "
                  "rename the field in its module",
                  path, field.name);
  MULLION_REQUIRE(field.entities == expected_entities(field, pane), Errc::shape,
                  "results: {} has {} entries but its pane {} ({}s)", path, field.entities,
                  expected_entities(field, pane), location_name(field.location));
  const Extents extents = field.components == 1 ? Extents{field.entities} : Extents{field.entities, field.components};
  if (field.f64 != nullptr || field.i32 == nullptr) image.dataset(path, field.f64, extents);
  else image.dataset(path, field.i32, extents);
  image.attribute(path, "unit", field.unit);
  image.attribute(path, "location", location_name(field.location));
  if (field.meaning) image.attribute(path, "meaning", *field.meaning);
}

/// What a mixed topology needs: each element's XDMF number, for points and lines its number of nodes, its nodes.
std::vector<std::int32_t> mixed_topology(const PaneData& pane)
{
  std::vector<std::int32_t> flat;
  for (const auto& block : pane.blocks)
    for (std::int64_t e = 0; e < block.n_elements; ++e) {
      flat.push_back(xdmf_numbers.at(block.element));
      if (block.element <= MULLION_LINE2) flat.push_back(static_cast<std::int32_t>(block.nodes_per_element));
      const auto* const nodes = block.connectivity + e * block.nodes_per_element;
      flat.insert(flat.end(), nodes, nodes + block.nodes_per_element);
    }
  return flat;
}

void write_mesh(ImageBuilder& image, const std::string& group, const PaneData& pane)
{
  image.group(group);
  image.attribute(group, "dimension", std::int64_t{pane.dimension});
  image.attribute(group, "n_nodes", pane.n_nodes);
  image.attribute(group, "n_elements", pane.n_elements);

  for (std::size_t b = 0; b < pane.blocks.size(); ++b) {
    const auto& block = pane.blocks[b];
    const auto path = fmt::format("{}/connectivity_{}", group, b);
    image.dataset(path, block.connectivity, {block.n_elements, block.nodes_per_element});
    image.attribute(path, "element", element_names.at(block.element));
  }
  if (pane.n_elements == 0) {
    std::vector<std::int32_t> points(static_cast<std::size_t>(pane.n_nodes));
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = static_cast<std::int32_t>(i);
    image.dataset(group + "/topology", points.data(), {pane.n_nodes, 1});
  } else if (pane.blocks.size() > 1) {
    const auto flat = mixed_topology(pane);
    image.dataset(group + "/topology", flat.data(), {static_cast<std::int64_t>(flat.size())});
  }

  for (const auto& field : pane.fields) write_field(image, group, pane, field);
  const auto is_reference = [](const FieldData& field) { return field.name == "reference_coordinates"; };
  if (std::any_of(pane.fields.begin(), pane.fields.end(), is_reference)) return; // the module's own
  const auto path = group + "/reference_coordinates";
  image.dataset(path, pane.reference_coordinates, {pane.n_nodes, std::int64_t{pane.dimension}});
  image.attribute(path, "unit", "m");
  image.attribute(path, "location", "node");
}

const FieldData* node_vector(const PaneData& pane, std::string_view name)
{
  for (const auto& field : pane.fields)
    if (field.name == name && field.location == MULLION_NODE && field.components == pane.dimension &&
        field.f64 != nullptr)
      return &field;
  return nullptr;
}

/// Where the nodes are now, (n_nodes x 3): `coordinates`, else reference plus `displacement`, else reference.
std::vector<double> geometry(const PaneData& pane)
{
  const auto* const coordinates = node_vector(pane, "coordinates");
  const auto* const displacement = coordinates == nullptr ? node_vector(pane, "displacement") : nullptr;
  const double* const base = coordinates != nullptr ? coordinates->f64 : pane.reference_coordinates;
  const std::size_t dimension = pane.dimension;
  const auto n_nodes = static_cast<std::size_t>(pane.n_nodes);
  std::vector<double> xyz(3 * n_nodes, 0.0);
  for (std::size_t i = 0; i < n_nodes; ++i)
    for (std::size_t d = 0; d < dimension; ++d) {
      const auto at = dimension * i + d;
      xyz[3 * i + d] = base[at] + (displacement != nullptr ? displacement->f64[at] : 0.0);
    }
  return xyz;
}

Bytes to_bytes(const std::string& text)
{
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

} // namespace

ResultsWriter::ResultsWriter(fs::path out, std::string run_name)
    : out_(std::move(out)), results_(out_ / "results"), run_name_(std::move(run_name))
{
}

ResultsWriter::~ResultsWriter()
{
  try {
    finish();
  } catch (...) {
    // finish() has joined the thread; whoever cares about the error calls it himself
  }
}

fs::path ResultsWriter::output_path(std::int64_t step) const { return results_ / (output_name(step) + ".h5"); }

void ResultsWriter::go_on_from(const OutputList& outputs)
{
  MULLION_ASSERT(index_.outputs().empty(), "outputs of earlier attempts come before those of this one");
  index_.restore(outputs);
  std::error_code error;
  index_.keep_if([&](const XdmfIndex::Output& output) { return fs::exists(output_path(output.step), error); });
  is_index_due_ = true;
  std::set<std::string> kept;
  for (const auto& output : index_.outputs()) kept.insert(output_name(output.step));
  for (const auto& entry : fs::directory_iterator(results_, error)) { // what the earlier attempt wrote after that
    const auto name = entry.path().stem().string();
    const bool is_output = name.find_first_not_of("0123456789") == std::string::npos;
    if (is_output && !kept.contains(name)) fs::remove(entry.path(), error);
  }
}

bool ResultsWriter::has_output(std::int64_t step) const
{
  const auto& outputs = index_.outputs();
  return std::any_of(outputs.begin(), outputs.end(), [&](const auto& output) { return output.step == step; });
}

bool ResultsWriter::wait_for_outputs()
{
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return files_.empty(); });
  return error_ == nullptr;
}

void ResultsWriter::begin(const std::vector<WindowData>& windows)
{
  MULLION_ASSERT(!has_begun_, "results of run '{}' begun twice", run_name_);
  make_folder(results_);
  remove_stale_temporaries(out_);
  remove_stale_temporaries(results_);

  ImageBuilder image;
  for (const auto& window : windows)
    for (const auto& pane : window.panes) {
      const auto group = pane_group(window, pane);
      check_pane(group, pane);
      MULLION_REQUIRE(panes_.try_emplace(group, PaneSize{pane.n_nodes, pane.n_elements}).second, Errc::shape,
                      "results: two panes are named {}", group);
      write_mesh(image, group, pane);
    }
  write_atomically(results_ / "mesh.h5", image.finish(), Trailer::checksum);
  index_.set_mesh(windows);
  has_begun_ = true;

  // signals are the orchestrator's main thread's; a limit on file sizes shall be an error here, not a signal
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  try {
    thread_ = std::thread([this] { run_thread(); });
  } catch (const std::system_error& error) {
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    throw Error(Errc::process, fmt::format("run '{}': no thread for writing results: {}", run_name_, error.what()));
  }
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

void ResultsWriter::write(std::int64_t step, double time, const std::vector<WindowData>& windows)
{
  MULLION_ASSERT(thread_.joinable(), "results of run '{}' written before begin() or after finish()", run_name_);
  const auto& outputs = index_.outputs();
  MULLION_ASSERT(step >= 0 && (outputs.empty() || outputs.back().step < step), "results of step {} after those of {}",
                 step, outputs.empty() ? -1 : outputs.back().step);

  ImageBuilder image;
  image.attribute("/", "step", step);
  image.attribute("/", "time", time);
  for (const auto& window : windows)
    for (const auto& pane : window.panes) {
      const auto group = pane_group(window, pane);
      const auto known = panes_.find(group);
      MULLION_REQUIRE(known != panes_.end() && known->second.n_nodes == pane.n_nodes &&
                          known->second.n_elements == pane.n_elements,
                      Errc::shape, "results of step {}: {} with {} nodes and {} elements is not in mesh.h5", step,
                      group, pane.n_nodes, pane.n_elements);
      const auto xyz = geometry(pane);
      const auto path = group + "/geometry";
      image.dataset(path, xyz.data(), {pane.n_nodes, 3});
      image.attribute(path, "unit", "m");
      image.attribute(path, "location", "node");
      for (const auto& field : pane.fields) write_field(image, group, pane, field);
    }
  std::vector<File> files;
  files.push_back({output_path(step), image.finish(), Trailer::checksum});

  {
    std::unique_lock lock(mutex_);
    wait_until_idle(lock); // before the index grows: an error takes the failed output out of it
  }
  index_.add(step, time, windows);
  is_index_due_ = true;
  try {
    if (Clock::now() >= next_index_)
      for (auto& file : index_files()) files.push_back(std::move(file));
  } catch (...) {
    index_.remove_last(); // it was never handed over
    throw;
  }
  submit(std::move(files), true);
}

std::vector<ResultsWriter::File> ResultsWriter::index_files()
{
  const auto start = Clock::now();
  ImageBuilder image;
  std::vector<std::int64_t> steps;
  std::vector<double> times;
  image.external_link("/mesh", "results/mesh.h5", "/");
  for (const auto& output : index_.outputs()) {
    const auto name = output_name(output.step);
    image.external_link("/" + name, "results/" + name + ".h5", "/");
    steps.push_back(output.step);
    times.push_back(output.time);
  }
  const auto n = static_cast<std::int64_t>(steps.size());
  image.dataset("/steps", steps.data(), {n});
  image.dataset("/times", times.data(), {n});
  image.attribute("/times", "unit", "s");
  std::vector<File> files;
  files.push_back({out_ / "results.h5", image.finish(), Trailer::checksum});
  files.push_back({out_ / "results.xdmf", to_bytes(index_.text()), Trailer::none});
  is_index_due_ = false;
  // a long index is written more rarely, so that it costs 2 % at most
  const auto now = Clock::now();
  next_index_ = now + std::max<Clock::duration>(index_interval, 50 * (now - start));
  return files;
}

void ResultsWriter::submit(std::vector<File> files, bool is_output)
{
  {
    std::unique_lock lock(mutex_);
    wait_until_idle(lock);
    files_ = std::move(files);
    is_output_ = is_output;
  }
  changed_.notify_all();
}

void ResultsWriter::wait_until_idle(std::unique_lock<std::mutex>& lock)
{
  changed_.wait(lock, [&] { return files_.empty(); });
  if (error_ == nullptr) return;
  if (is_output_) index_.remove_last(); // the failed output, which was the only one in flight
  is_index_due_ = true;
  std::rethrow_exception(std::exchange(error_, nullptr));
}

void ResultsWriter::run_thread()
{
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return is_ending_ || !files_.empty(); });
    if (files_.empty()) return;
    lock.unlock();
    std::exception_ptr error;
    bool is_output_written = false;
    try {
      for (const auto& file : files_) { // files_ is this thread's until it is empty
        write_atomically(file.path, file.content, file.trailer);
        is_output_written = true;
      }
    } catch (const Error& failure) {
      error = std::make_exception_ptr(Error(failure.code(), fmt::format("run '{}': {}", run_name_, failure.what())));
    } catch (...) {
      error = std::current_exception();
    }
    lock.lock();
    files_ = {};
    is_output_ = is_output_ && !is_output_written;
    error_ = error;
    changed_.notify_all();
  }
}

void ResultsWriter::flush()
{
  const auto wait = [&] {
    std::unique_lock lock(mutex_);
    wait_until_idle(lock);
  };
  if (!thread_.joinable()) return;
  wait(); // a failure here takes the output out of the index
  if (!is_index_due_) return;
  submit(index_files(), false);
  wait();
}

void ResultsWriter::finish()
{
  if (!thread_.joinable()) return;
  std::exception_ptr error;
  for (int attempt = 0; attempt < 2; ++attempt) // the second writes the index without an output that failed
    try {
      flush();
      break;
    } catch (...) {
      if (error == nullptr) error = std::current_exception();
    }
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
  if (error != nullptr) std::rethrow_exception(error);
}

} // namespace mullion::io
