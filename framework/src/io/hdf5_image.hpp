// HDF5 files that exist in memory only: ImageBuilder makes one and returns its bytes, ImageReader opens bytes. The
// library never touches a disk (core driver, no backing store), so a full disk or a kill cannot damage a
// file through it; and the bytes are a function of what was put in (no time stamps). HDF5's C library is not
// thread-safe here: one thread of the process makes all these calls. Paths are absolute, "/group/dataset".
#pragma once

#include "io/atomic_file.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace mullion::io {

/// An open HDF5 object; closed with the handle. (hid_t without its header.)
class Hdf5Handle {
public:
  using Close = int (*)(std::int64_t);
  Hdf5Handle() = default;
  Hdf5Handle(std::int64_t id, Close close) : id_(id), close_(close) {}
  ~Hdf5Handle() { reset(); }
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept;
  [[nodiscard]] std::int64_t get() const { return id_; }
  void reset() noexcept;

private:
  std::int64_t id_ = -1;
  Close close_ = nullptr;
};

/// The bytes of a finished file in memory of their own, handed over as the library left them: a copy of a large image
/// would cost as much as building it. Unmapped with the object.
class Image {
public:
  Image() = default;
  Image(std::byte* data, std::size_t size, std::size_t mapped) : data_(data), size_(size), mapped_(mapped) {}
  Image(Image&& other) noexcept { *this = std::move(other); }
  Image& operator=(Image&& other) noexcept;
  ~Image();
  operator std::span<const std::byte>() const { return {data_, size_}; } // NOLINT: it is one
  [[nodiscard]] std::size_t size() const { return size_; }

private:
  std::byte* data_ = nullptr;
  std::size_t size_ = 0, mapped_ = 0;
};

using Extents = std::vector<std::int64_t>; ///< slowest first, as HDF5 and C count

/// Builds one file. Groups on the way are made as needed; everything written once.
/// All functions throw Error Errc::io with HDF5's own text, naming the object.
class ImageBuilder {
public:
  ImageBuilder();

  void group(const std::string& path);
  void dataset(const std::string& path, const double* values, const Extents& extents);
  void dataset(const std::string& path, const std::int32_t* values, const Extents& extents);
  void dataset(const std::string& path, const std::int64_t* values, const Extents& extents);
  /// Texts: UTF-8, all as long as the longest, zeros behind the others.
  void dataset(const std::string& path, const std::vector<std::string>& texts);
  /// Raw bytes (for opaque blocks such as a window's memory), as unsigned 8-bit integers.
  void dataset(const std::string& path, std::span<const std::byte> values);
  /// Attributes of a group or dataset that exists; texts are UTF-8 of variable length.
  void attribute(const std::string& path, const std::string& name, std::string_view text);
  void attribute(const std::string& path, const std::string& name, double value);
  void attribute(const std::string& path, const std::string& name, std::int64_t value);
  /// `path` becomes the object `target` of the file `file`, found relative to this one's folder.
  void external_link(const std::string& path, const std::string& file, const std::string& target);

  /// The finished file; the builder is empty afterwards.
  [[nodiscard]] Bytes finish();
  /// The same without a copy.
  [[nodiscard]] Image take();

private:
  void make_parents(const std::string& path);
  void write(const std::string& path, std::int64_t file_type, std::int64_t memory_type, const void* values,
             const Extents& extents);
  void write_attribute(const std::string& path, const std::string& name, std::int64_t type, const void* value);

  struct Memory; ///< where the library builds the file
  std::shared_ptr<Memory> memory_;
  Hdf5Handle file_, plain_dataset_, plain_group_; ///< the creation properties without time stamps
  std::set<std::string> groups_;
};

/// Reads the bytes of a file. Verify them first (read_checked): HDF5 itself notices few altered bytes.
/// All functions throw Error Errc::io, naming `source` and the object.
class ImageReader {
public:
  /// @param source  what to call the file in messages
  ImageReader(std::span<const std::byte> image, std::string source);

  [[nodiscard]] bool has(const std::string& path) const;
  [[nodiscard]] std::vector<std::string> names(const std::string& group) const; ///< sorted
  [[nodiscard]] Extents extents(const std::string& path) const;
  [[nodiscard]] bool holds_f64(const std::string& path) const; ///< whether f64() can read it
  [[nodiscard]] std::vector<double> f64(const std::string& path) const;
  [[nodiscard]] std::vector<std::int32_t> i32(const std::string& path) const;
  [[nodiscard]] std::vector<std::int64_t> i64(const std::string& path) const;
  [[nodiscard]] std::vector<std::string> texts(const std::string& path) const;
  [[nodiscard]] Bytes bytes(const std::string& path) const;
  [[nodiscard]] std::string text_attribute(const std::string& path, const std::string& name) const;
  [[nodiscard]] double f64_attribute(const std::string& path, const std::string& name) const;
  [[nodiscard]] std::int64_t i64_attribute(const std::string& path, const std::string& name) const;

private:
  /// Entries of a dataset. Ours are stored whole and as they are: one that claims more than the file has is damage,
  /// and no memory is asked for.
  [[nodiscard]] std::size_t count(const std::string& path, std::size_t each) const;
  template <class T> std::vector<T> read(const std::string& path, std::int64_t type) const;
  void read_attribute(const std::string& path, const std::string& name, int type_class, std::int64_t type,
                      void* value) const;

  std::string source_;
  std::size_t size_; ///< of the file [bytes]
  Hdf5Handle file_;
};

} // namespace mullion::io
