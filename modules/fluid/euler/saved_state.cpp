// Two readers: comma-separated values, and the HDF5 files of results.
#include "saved_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <hdf5.h>
#include <sstream>

namespace mullion::euler {

namespace {

std::string text_of(double x)
{
  std::ostringstream out;
  out << x;
  return out.str();
}

struct Line {
  Vec<2> x;
  Values<2> w;
};

std::vector<std::string> parts_of(const std::string& line)
{
  std::vector<std::string> parts;
  std::istringstream in(line);
  for (std::string part; std::getline(in, part, ',');) {
    const auto first = part.find_first_not_of(" \t\r");
    parts.push_back(first == std::string::npos ? "" : part.substr(first, part.find_last_not_of(" \t\r") - first + 1));
  }
  return parts;
}

std::vector<Line> read_lines(const std::string& file)
{
  std::ifstream in(file);
  if (!in) throw SavedStateError(file + ": cannot be read");
  std::string line;
  std::getline(in, line);
  const auto header = parts_of(line);
  std::array<std::size_t, 6> column{};
  const std::array<const char*, 6> names = {"x", "y", "rho", "u", "v", "p"};
  for (std::size_t k = 0; k < 6; ++k) {
    const auto it = std::find(header.begin(), header.end(), names[k]);
    if (it == header.end())
      throw SavedStateError(file + ": no column " + names[k] +
                            " in its first line; expected x,y,rho,u,v,p in any order");
    column[k] = static_cast<std::size_t>(it - header.begin());
  }
  std::vector<Line> lines;
  for (std::size_t number = 2; std::getline(in, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    const auto parts = parts_of(line);
    std::array<double, 6> value{};
    for (std::size_t k = 0; k < 6; ++k) {
      const std::string part = column[k] < parts.size() ? parts[column[k]] : "";
      char* end = nullptr;
      value[k] = std::strtod(part.c_str(), &end);
      if (part.empty() || *end != '\0' || !std::isfinite(value[k]))
        throw SavedStateError(file + ":" + std::to_string(number) + ": \"" + part + "\" is no number (column " +
                              names[k] + ")");
    }
    lines.push_back({{value[0], value[1]}, {value[2], value[3], value[4], value[5]}});
  }
  return lines;
}

std::vector<Values<2>> from_csv(const std::string& file, const Gas& gas, std::span<const Vec<2>> centroid,
                                std::span<const double> volume)
{
  auto lines = read_lines(file);
  std::sort(lines.begin(), lines.end(), [](const Line& l, const Line& r) { return l.x.x() < r.x.x(); });
  std::vector<Values<2>> amounts(centroid.size());
  for (std::size_t c = 0; c < centroid.size(); ++c) {
    const double near = 1e-6 * std::sqrt(volume[c]);
    const auto at = [&](const Vec<2>& x) { return "(" + text_of(x.x()) + ", " + text_of(x.y()) + ") m"; };
    auto it = std::lower_bound(lines.begin(), lines.end(), centroid[c].x() - near,
                               [](const Line& line, double x) { return line.x.x() < x; });
    while (it != lines.end() && it->x.x() <= centroid[c].x() + near && (it->x - centroid[c]).norm() > near) ++it;
    if (it == lines.end() || (it->x - centroid[c]).norm() > near)
      throw SavedStateError(file + ": none of its " + std::to_string(lines.size()) + " lines is at " + at(centroid[c]) +
                            ", the centroid of cell " + std::to_string(c) + " of " + std::to_string(centroid.size()) +
                            ", to " + text_of(near) + " m; it must be of the same mesh");
    if (!is_gas<2>(it->w))
      throw SavedStateError(file + ": the density or the pressure at " + at(it->x) + " is not positive");
    amounts[c] = conserved<2>(gas, it->w);
    for (auto& value : amounts[c]) value *= volume[c];
  }
  return amounts;
}

/// An HDF5 handle that closes itself.
struct Handle {
  hid_t id = -1;
  herr_t (*close)(hid_t) = nullptr;
  Handle(hid_t handle, herr_t (*closer)(hid_t)) : id(handle), close(closer) {}
  ~Handle()
  {
    if (id >= 0) close(id);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
};

herr_t find_volume(hid_t root, const char* name, const H5L_info_t*, void* found)
{
  const std::string path = std::string(name) + "/volume";
  if (H5Lexists(root, path.c_str(), H5P_DEFAULT) > 0)
    if (H5Lexists(root, (path + "/pane_0").c_str(), H5P_DEFAULT) > 0 &&
        H5Lexists(root, (path + "/pane_0/mass").c_str(), H5P_DEFAULT) > 0)
      static_cast<std::vector<std::string>*>(found)->push_back(path + "/pane_0/");
  return 0;
}

std::vector<double> read_array(const std::string& file, hid_t root, const std::string& path, std::size_t expected)
{
  const Handle set(H5Dopen2(root, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (set.id < 0) throw SavedStateError(file + ": has no " + path);
  const Handle space(H5Dget_space(set.id), H5Sclose);
  const auto n = H5Sget_simple_extent_npoints(space.id);
  if (n != static_cast<hssize_t>(expected))
    throw SavedStateError(file + ": " + path + " has " + std::to_string(n) + " numbers, the mesh needs " +
                          std::to_string(expected) + "; it must be of the same mesh");
  std::vector<double> values(expected);
  if (H5Dread(set.id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    throw SavedStateError(file + ": " + path + " cannot be read");
  return values;
}

std::vector<Values<2>> from_results(const std::string& file, const Eigen::Matrix2Xd& nodes,
                                    std::span<const double> volume)
{
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); // what goes wrong is said below
  const Handle root(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (root.id < 0) throw SavedStateError(file + ": cannot be read as HDF5");
  std::vector<std::string> found;
  H5Literate(root.id, H5_INDEX_NAME, H5_ITER_INC, nullptr, find_volume, &found);
  if (found.size() != 1)
    throw SavedStateError(
        file + ": has " + std::to_string(found.size()) +
        " windows volume with a mass, expected one; it must be a file of results/ of a run with this module");
  const auto& path = found[0];
  const std::size_t n = volume.size();
  const auto geometry = read_array(file, root.id, path + "geometry", static_cast<std::size_t>(nodes.cols()) * 3);
  const double h = std::sqrt(*std::min_element(volume.begin(), volume.end()));
  for (Eigen::Index i = 0; i < nodes.cols(); ++i) {
    const auto k = static_cast<std::size_t>(3 * i);
    if (std::hypot(geometry[k] - nodes(0, i), geometry[k + 1] - nodes(1, i)) > 1e-6 * h)
      throw SavedStateError(file + ": node " + std::to_string(i) + " is at (" + text_of(geometry[k]) + ", " +
                            text_of(geometry[k + 1]) + ") m, in this mesh at (" + text_of(nodes(0, i)) + ", " +
                            text_of(nodes(1, i)) + ") m; it must be of the same mesh");
  }
  const auto mass = read_array(file, root.id, path + "mass", n);
  const auto momentum = read_array(file, root.id, path + "momentum", 2 * n);
  const auto energy = read_array(file, root.id, path + "energy", n);
  std::vector<Values<2>> amounts(n);
  for (std::size_t c = 0; c < n; ++c) amounts[c] = {mass[c], momentum[2 * c], momentum[2 * c + 1], energy[c]};
  return amounts;
}

} // namespace

std::vector<Values<2>> saved_state(const std::string& file, const Gas& gas, const Eigen::Matrix2Xd& nodes,
                                   std::span<const Vec<2>> centroid, std::span<const double> volume)
{
  const auto ends_with = [&](const std::string& end) {
    return file.size() > end.size() && file.compare(file.size() - end.size(), end.size(), end) == 0;
  };
  if (ends_with(".csv")) return from_csv(file, gas, centroid, volume);
  if (ends_with(".h5")) return from_results(file, nodes, volume);
  throw SavedStateError(file + ": its name must end with .csv or .h5");
}

} // namespace mullion::euler
