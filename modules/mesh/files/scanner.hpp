// Walks through the bytes of a mesh file, as words or as raw bytes, and says where it was when something is wrong.
// Nothing is allocated on the word of the file: a count that the rest of the file cannot hold is an error at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace mullion::mesh_files {

class Scanner {
public:
  /// @param file   for messages
  /// @param bytes  must outlive the scanner
  Scanner(std::string file, std::string_view bytes) : file_(std::move(file)), bytes_(bytes) {}

  /// Say "byte N" instead of a line in messages from here on.
  void set_binary(bool is_binary) { is_binary_ = is_binary; }

  [[nodiscard]] std::size_t remaining() const { return bytes_.size() - position_; }
  [[nodiscard]] std::size_t position() const { return position_; }

  /// What is left of this line, without its end; the next read begins after it.
  std::string_view line();
  /// The next word; "" at the end of the file.
  std::string_view word();
  /// The next word, without passing it.
  [[nodiscard]] std::string_view next_word() const;
  /// The next word, which must be this one.
  void expect(std::string_view word);
  /// The next word as a number. @param what for messages: "the number of nodes"
  std::int64_t integer(const std::string& what);
  double real(const std::string& what);
  /// A text in double quotes on this line.
  std::string quoted(const std::string& what);
  /// Raw bytes.
  std::string_view raw(std::size_t n, const std::string& what);

  /// Check that a number of things, each at least so many bytes long, fits into the rest of the file.
  std::size_t fits(std::int64_t n, std::size_t bytes_each, const std::string& what) const;

  /// @throws FileError "FILE:LINE: found; right", at the begin of what was read last
  [[noreturn]] void fail(const std::string& found, const std::string& right) const;

private:
  void skip_blanks();
  std::string file_;
  std::string_view bytes_;
  std::size_t position_ = 0, last_ = 0; ///< last_: where the last read began
  bool is_binary_ = false;
};

/// A word as a number; false if it is none. Takes what C++ calls a number, in any locale, and a leading +.
bool to_number(std::string_view word, double& value);
bool to_number(std::string_view word, std::int64_t& value);

/// A piece of a damaged file for a message: its first 40 bytes, those that cannot be printed as '?'.
std::string shown(std::string_view text);

} // namespace mullion::mesh_files
