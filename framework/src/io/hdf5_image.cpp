#include "io/hdf5_image.hpp"

#include <mullion/sdk/error.hpp>

#include <hdf5.h>

#include <sys/mman.h>

#include <algorithm>
#include <cstring>

namespace mullion::io {
namespace {

static_assert(std::is_same_v<hid_t, std::int64_t> && std::is_same_v<herr_t, int>);

constexpr std::size_t core_increment = std::size_t{1} << 20; // growth of an image in memory [bytes]
constexpr std::size_t huge_page = std::size_t{2} << 20;      // [bytes]

/// HDF5 prints its error stack to standard error unless told not to; ours becomes the text of an Error.
void silence()
{
  static const bool done = H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr) >= 0;
  (void)done;
}

herr_t keep_deepest(unsigned n, const H5E_error2_t* entry, void* text)
{
  if (n == 0 && entry->desc != nullptr) *static_cast<std::string*>(text) = entry->desc;
  return 0;
}

[[noreturn]] void fail(std::string_view what, std::string_view where)
{
  std::string text;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_deepest, &text); // upward starts at the cause
  H5Eclear2(H5E_DEFAULT);
  throw Error(Errc::io, fmt::format("HDF5 cannot {} {}: {}", what, where, text.empty() ? "no reason given" : text));
}

Hdf5Handle own(hid_t id, Hdf5Handle::Close close, std::string_view what, std::string_view where)
{
  if (id < 0) fail(what, where);
  return {id, close};
}

void check(herr_t status, std::string_view what, std::string_view where)
{
  if (status < 0) fail(what, where);
}

Hdf5Handle core_access()
{
  silence();
  auto access = own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make", "file access properties");
  check(H5Pset_fapl_core(access.get(), core_increment, 0), "choose", "the core driver");
  return access;
}

/// The core driver tells open files apart by their names, so each gets its own. The name is not stored.
std::string unique_name()
{
  static std::int64_t count = 0;
  return fmt::format("mullion-image-{}", ++count);
}

Hdf5Handle timeless(hid_t property_class)
{
  auto properties = own(H5Pcreate(property_class), H5Pclose, "make", "creation properties");
  check(H5Pset_obj_track_times(properties.get(), false), "turn off", "time stamps");
  return properties;
}

Hdf5Handle variable_text()
{
  auto type = own(H5Tcopy(H5T_C_S1), H5Tclose, "make", "a text type");
  check(H5Tset_size(type.get(), H5T_VARIABLE), "size", "a text type");
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "set", "the character set of a text type");
  return type;
}

/// Datasets hold texts of one length: those of variable length need a fill value, and lie scattered in the file.
Hdf5Handle fixed_text(std::size_t longest)
{
  auto type = own(H5Tcopy(H5T_C_S1), H5Tclose, "make", "a text type");
  check(H5Tset_size(type.get(), longest), "size", "a text type");
  check(H5Tset_strpad(type.get(), H5T_STR_NULLPAD), "pad", "a text type");
  check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "set", "the character set of a text type");
  return type;
}

} // namespace

Hdf5Handle& Hdf5Handle::operator=(Hdf5Handle&& other) noexcept
{
  std::swap(id_, other.id_);
  std::swap(close_, other.close_);
  return *this;
}

void Hdf5Handle::reset() noexcept
{
  if (id_ >= 0) close_(id_);
  id_ = -1;
}

Image& Image::operator=(Image&& other) noexcept
{
  std::swap(data_, other.data_);
  std::swap(size_, other.size_);
  std::swap(mapped_, other.mapped_);
  return *this;
}

Image::~Image()
{
  if (data_ != nullptr) ::munmap(data_, mapped_);
}

// ---- the library's memory ---------------------------------------------------------------------------------

/// The core driver asks these functions for its one block of memory. Ours is a mapping, which grows without a copy, in
/// large pages where the machine has them (touching small ones for the first time costs more than filling them), and
/// which outlives the file.
struct ImageBuilder::Memory {
  std::byte* data = nullptr;
  std::size_t mapped = 0;

  ~Memory()
  {
    if (data != nullptr) ::munmap(data, mapped);
  }
  static void* resize(void* at, std::size_t size, H5FD_file_image_op_t, void* memory)
  {
    auto& self = *static_cast<Memory*>(memory);
    if (at != nullptr && at != self.data) return nullptr;
    const auto needed = (size + huge_page - 1) / huge_page * huge_page;
    if (needed <= self.mapped) return self.data;
    void* const moved = self.data == nullptr
                            ? ::mmap(nullptr, needed, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0)
                            : ::mremap(self.data, self.mapped, needed, MREMAP_MAYMOVE);
    if (moved == MAP_FAILED) return nullptr;
    self.data = static_cast<std::byte*>(moved);
    self.mapped = needed;
    if (needed > huge_page) ::madvise(self.data, self.mapped, MADV_HUGEPAGE); // a hint: it may be refused
    return self.data;
  }
  static void* allocate(std::size_t size, H5FD_file_image_op_t op, void* memory)
  {
    return resize(nullptr, size, op, memory);
  }
  static void* copy(void* to, const void* from, std::size_t size, H5FD_file_image_op_t, void*)
  {
    return std::memcpy(to, from, size);
  }
  static herr_t release(void*, H5FD_file_image_op_t, void*) { return 0; } // with the object
  static void* share(void* memory) { return memory; }
  static herr_t unshare(void*) { return 0; }
};

// ---- building ---------------------------------------------------------------------------------------------

ImageBuilder::ImageBuilder()
{
  const auto access = core_access();
  memory_ = std::make_shared<Memory>();
  H5FD_file_image_callbacks_t callbacks{&Memory::allocate, &Memory::copy,    &Memory::resize, &Memory::release,
                                        &Memory::share,    &Memory::unshare, memory_.get()};
  check(H5Pset_file_image_callbacks(access.get(), &callbacks), "take memory for", "a file in memory");
  const auto creation = timeless(H5P_FILE_CREATE); // the root group's
  plain_dataset_ = timeless(H5P_DATASET_CREATE);
  check(H5Pset_fill_time(plain_dataset_.get(), H5D_FILL_TIME_NEVER), "turn off", "fill values");
  plain_group_ = timeless(H5P_GROUP_CREATE);
  const auto name = unique_name();
  file_ =
      own(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose, "make", "a file in memory");
}

void ImageBuilder::group(const std::string& path)
{
  MULLION_ASSERT(path.size() > 1 && path[0] == '/' && path.back() != '/', "HDF5 path '{}'", path);
  if (groups_.contains(path)) return;
  make_parents(path);
  own(H5Gcreate2(file_.get(), path.c_str(), H5P_DEFAULT, plain_group_.get(), H5P_DEFAULT), H5Gclose, "make the group",
      path);
  groups_.insert(path);
}

void ImageBuilder::make_parents(const std::string& path)
{
  MULLION_ASSERT(!path.empty() && path[0] == '/', "HDF5 path '{}' is not absolute", path);
  const auto end = path.rfind('/');
  if (end > 0) group(path.substr(0, end));
}

void ImageBuilder::dataset(const std::string& path, const double* values, const Extents& extents)
{
  write(path, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, values, extents);
}

void ImageBuilder::dataset(const std::string& path, const std::int32_t* values, const Extents& extents)
{
  write(path, H5T_STD_I32LE, H5T_NATIVE_INT32, values, extents);
}

void ImageBuilder::dataset(const std::string& path, const std::int64_t* values, const Extents& extents)
{
  write(path, H5T_STD_I64LE, H5T_NATIVE_INT64, values, extents);
}

void ImageBuilder::dataset(const std::string& path, const std::vector<std::string>& texts)
{
  std::size_t longest = 1; // a type of no bytes there is not
  for (const auto& text : texts) longest = std::max(longest, text.size());
  std::string block; // zeros behind the shorter ones
  for (const auto& text : texts) (block += text).append(longest - text.size(), '\0');
  const auto type = fixed_text(longest);
  write(path, type.get(), type.get(), block.data(), {static_cast<std::int64_t>(texts.size())});
}

void ImageBuilder::dataset(const std::string& path, std::span<const std::byte> values)
{
  write(path, H5T_STD_U8LE, H5T_NATIVE_UINT8, values.data(), {static_cast<std::int64_t>(values.size())});
}

void ImageBuilder::write(const std::string& path, std::int64_t file_type, std::int64_t memory_type, const void* values,
                         const Extents& extents)
{
  make_parents(path);
  const std::vector<hsize_t> sizes(extents.begin(), extents.end());
  const auto space = own(H5Screate_simple(static_cast<int>(sizes.size()), sizes.data(), nullptr), H5Sclose,
                         "make the extents of", path);
  const auto set =
      own(H5Dcreate2(file_.get(), path.c_str(), file_type, space.get(), H5P_DEFAULT, plain_dataset_.get(), H5P_DEFAULT),
          H5Dclose, "make the dataset", path);
  if (std::find(extents.begin(), extents.end(), 0) != extents.end()) return;
  MULLION_ASSERT(values != nullptr, "no values for the HDF5 dataset {}", path);
  check(H5Dwrite(set.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), "write", path);
}

void ImageBuilder::attribute(const std::string& path, const std::string& name, std::string_view text)
{
  const std::string terminated(text);
  const char* pointer = terminated.c_str();
  write_attribute(path, name, variable_text().get(), &pointer);
}

void ImageBuilder::attribute(const std::string& path, const std::string& name, double value)
{
  write_attribute(path, name, H5T_IEEE_F64LE, &value);
}

void ImageBuilder::attribute(const std::string& path, const std::string& name, std::int64_t value)
{
  write_attribute(path, name, H5T_STD_I64LE, &value);
}

void ImageBuilder::write_attribute(const std::string& path, const std::string& name, std::int64_t type,
                                   const void* value)
{
  const auto where = path + "@" + name;
  const auto space = own(H5Screate(H5S_SCALAR), H5Sclose, "make the attribute", where);
  const auto attribute = own(H5Acreate_by_name(file_.get(), path.c_str(), name.c_str(), type, space.get(), H5P_DEFAULT,
                                               H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose, "make the attribute", where);
  check(H5Awrite(attribute.get(), type, value), "write the attribute", where);
}

void ImageBuilder::external_link(const std::string& path, const std::string& file, const std::string& target)
{
  make_parents(path);
  check(H5Lcreate_external(file.c_str(), target.c_str(), file_.get(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT), "link",
        path);
}

Image ImageBuilder::take()
{
  check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), "flush", "a file in memory");
  const auto size = H5Fget_file_image(file_.get(), nullptr, 0);
  if (size < 0) fail("measure", "a file in memory");
  file_.reset();
  groups_.clear();
  auto& memory = *memory_;
  MULLION_ASSERT(static_cast<std::size_t>(size) <= memory.mapped, "an image of {} bytes in {}", size, memory.mapped);
  return {std::exchange(memory.data, nullptr), static_cast<std::size_t>(size), std::exchange(memory.mapped, 0)};
}

Bytes ImageBuilder::finish()
{
  const auto image = take();
  const std::span<const std::byte> bytes = image;
  return {bytes.begin(), bytes.end()};
}

// ---- reading ----------------------------------------------------------------------------------------------

ImageReader::ImageReader(std::span<const std::byte> image, std::string source)
    : source_(std::move(source)), size_(image.size())
{
  const auto access = core_access();
  // HDF5 copies the buffer; it takes a non-const pointer and leaves the bytes alone
  check(H5Pset_file_image(access.get(), const_cast<std::byte*>(image.data()), image.size()), "take in", source_);
  const auto name = unique_name();
  file_ = own(H5Fopen(name.c_str(), H5F_ACC_RDONLY, access.get()), H5Fclose, "open", source_);
}

bool ImageReader::has(const std::string& path) const
{
  for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
    if (path == "/") return true;
    if (H5Lexists(file_.get(), path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
    if (end == std::string::npos) return true;
  }
}

std::vector<std::string> ImageReader::names(const std::string& group) const
{
  const auto where = source_ + ":" + group;
  const auto opened = own(H5Gopen2(file_.get(), group.c_str(), H5P_DEFAULT), H5Gclose, "open", where);
  std::vector<std::string> found;
  const auto keep = [](hid_t, const char* name, const H5L_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  check(H5Literate(opened.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, keep, &found), "list", where);
  return found;
}

Extents ImageReader::extents(const std::string& path) const
{
  const auto where = source_ + ":" + path;
  const auto set = own(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose, "open", where);
  const auto space = own(H5Dget_space(set.get()), H5Sclose, "measure", where);
  const int rank = H5Sget_simple_extent_ndims(space.get());
  if (rank < 0) fail("measure", where);
  std::vector<hsize_t> sizes(static_cast<std::size_t>(rank));
  check(H5Sget_simple_extent_dims(space.get(), sizes.data(), nullptr), "measure", where);
  return {sizes.begin(), sizes.end()};
}

bool ImageReader::holds_f64(const std::string& path) const
{
  const auto where = source_ + ":" + path;
  const auto set = own(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose, "open", where);
  const auto stored = own(H5Dget_type(set.get()), H5Tclose, "read the type of", where);
  return H5Tget_class(stored.get()) == H5T_FLOAT && H5Tget_size(stored.get()) == sizeof(double);
}

std::size_t ImageReader::count(const std::string& path, std::size_t each) const
{
  const auto sizes = extents(path);
  if (std::find(sizes.begin(), sizes.end(), 0) != sizes.end()) return 0;
  std::uint64_t n = 1;
  for (const auto size : sizes) {
    const auto more = static_cast<std::uint64_t>(size);
    MULLION_REQUIRE(size > 0 && more <= size_ / n, Errc::io,
                    "{}:{} claims to have {} times {} entries, in a file of {} bytes", source_, path, n, more, size_);
    n *= more;
  }
  MULLION_REQUIRE(each > 0 && n <= size_ / each, Errc::io,
                  "{}:{} claims to have {} entries of {} bytes, in a file of {}", source_, path, n, each, size_);
  return n;
}

template <class T> std::vector<T> ImageReader::read(const std::string& path, std::int64_t type) const
{
  const auto where = source_ + ":" + path;
  const auto set = own(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose, "open", where);
  const auto stored = own(H5Dget_type(set.get()), H5Tclose, "read the type of", where);
  MULLION_REQUIRE(H5Tget_class(stored.get()) == H5Tget_class(type) && H5Tget_size(stored.get()) == sizeof(T), Errc::io,
                  "{} does not hold numbers of the expected type ({} bytes each)", where, sizeof(T));
  std::vector<T> values(count(path, sizeof(T)));
  if (values.empty()) return values;
  check(H5Dread(set.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "read", where);
  return values;
}

std::vector<double> ImageReader::f64(const std::string& path) const { return read<double>(path, H5T_NATIVE_DOUBLE); }

std::vector<std::int32_t> ImageReader::i32(const std::string& path) const
{
  return read<std::int32_t>(path, H5T_NATIVE_INT32);
}

std::vector<std::int64_t> ImageReader::i64(const std::string& path) const
{
  return read<std::int64_t>(path, H5T_NATIVE_INT64);
}

std::vector<std::string> ImageReader::texts(const std::string& path) const
{
  const auto where = source_ + ":" + path;
  const auto set = own(H5Dopen2(file_.get(), path.c_str(), H5P_DEFAULT), H5Dclose, "open", where);
  const auto stored = own(H5Dget_type(set.get()), H5Tclose, "read the type of", where);
  MULLION_REQUIRE(H5Tget_class(stored.get()) == H5T_STRING && H5Tis_variable_str(stored.get()) == 0 &&
                      extents(path).size() == 1,
                  Errc::io, "{} does not hold a list of texts", where);
  const auto longest = H5Tget_size(stored.get());
  std::string block(longest * count(path, longest), '\0');
  if (!block.empty())
    check(H5Dread(set.get(), fixed_text(longest).get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, block.data()), "read", where);
  std::vector<std::string> texts;
  for (std::size_t begin = 0; begin < block.size(); begin += longest) {
    const auto text = std::string_view(block).substr(begin, longest);
    texts.emplace_back(text.substr(0, text.find('\0')));
  }
  return texts;
}

Bytes ImageReader::bytes(const std::string& path) const { return read<std::byte>(path, H5T_NATIVE_UINT8); }

void ImageReader::read_attribute(const std::string& path, const std::string& name, int type_class, std::int64_t type,
                                 void* value) const
{
  const auto where = source_ + ":" + path + "@" + name;
  const auto attribute =
      own(H5Aopen_by_name(file_.get(), path.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose, "open", where);
  const auto stored = own(H5Aget_type(attribute.get()), H5Tclose, "read the type of", where);
  const auto space = own(H5Aget_space(attribute.get()), H5Sclose, "measure", where);
  MULLION_REQUIRE(H5Tget_class(stored.get()) == type_class && H5Sget_simple_extent_npoints(space.get()) == 1 &&
                      (type_class != H5T_STRING || H5Tis_variable_str(stored.get()) > 0),
                  Errc::io, "{} is not of the expected type", where);
  check(H5Aread(attribute.get(), type, value), "read", where);
}

std::string ImageReader::text_attribute(const std::string& path, const std::string& name) const
{
  char* text = nullptr;
  read_attribute(path, name, H5T_STRING, variable_text().get(), &text);
  std::string copy = text == nullptr ? "" : text;
  H5free_memory(text);
  return copy;
}

double ImageReader::f64_attribute(const std::string& path, const std::string& name) const
{
  double value = 0.0;
  read_attribute(path, name, H5T_FLOAT, H5T_NATIVE_DOUBLE, &value);
  return value;
}

std::int64_t ImageReader::i64_attribute(const std::string& path, const std::string& name) const
{
  std::int64_t value = 0;
  read_attribute(path, name, H5T_INTEGER, H5T_NATIVE_INT64, &value);
  return value;
}

} // namespace mullion::io
