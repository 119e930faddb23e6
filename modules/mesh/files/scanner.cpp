#include "scanner.hpp"

#include "file_error.hpp"

#include <algorithm>
#include <charconv>

namespace mullion::mesh_files {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

template <class T> bool convert(std::string_view word, T& value)
{
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size();
}

} // namespace

bool to_number(std::string_view word, double& value) { return convert(word, value); }
bool to_number(std::string_view word, std::int64_t& value) { return convert(word, value); }

std::string shown(std::string_view text)
{
  std::string out(text.substr(0, 40));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
  return text.size() > 40 ? out + "..." : out;
}

void Scanner::skip_blanks()
{
  while (position_ < bytes_.size() && is_blank(bytes_[position_])) ++position_;
}

std::string_view Scanner::line()
{
  last_ = position_;
  const auto end = std::min(bytes_.find('\n', position_), bytes_.size());
  auto line = bytes_.substr(position_, end - position_);
  position_ = std::min(end + 1, bytes_.size());
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  return line;
}

std::string_view Scanner::word()
{
  skip_blanks();
  last_ = position_;
  while (position_ < bytes_.size() && !is_blank(bytes_[position_])) ++position_;
  return bytes_.substr(last_, position_ - last_);
}

std::string_view Scanner::next_word() const
{
  Scanner ahead = *this;
  return ahead.word();
}

void Scanner::expect(std::string_view expected)
{
  const auto found = word();
  if (found != expected) fail(join("found \"", shown(found), '"'), join("expected ", expected));
}

std::int64_t Scanner::integer(const std::string& what)
{
  const auto found = word();
  std::int64_t value = 0;
  if (!to_number(found, value)) fail(join("found \"", shown(found), '"'), join("expected ", what, ", an integer"));
  return value;
}

double Scanner::real(const std::string& what)
{
  const auto found = word();
  double value = 0;
  if (!to_number(found, value)) fail(join("found \"", shown(found), '"'), join("expected ", what, ", a number"));
  return value;
}

std::string Scanner::quoted(const std::string& what)
{
  const auto rest = line();
  const auto open = rest.find('"');
  const auto close = open == std::string_view::npos ? open : rest.find('"', open + 1);
  if (close == std::string_view::npos)
    fail(join("found \"", shown(rest), '"'), join("expected ", what, " in double quotes"));
  return std::string(rest.substr(open + 1, close - open - 1));
}

std::string_view Scanner::raw(std::size_t n, const std::string& what)
{
  last_ = position_;
  if (n > remaining()) fail(join("the file ends after ", remaining(), " bytes"), join(what, " needs ", n));
  position_ += n;
  return bytes_.substr(last_, n);
}

std::size_t Scanner::fits(std::int64_t n, std::size_t bytes_each, const std::string& what) const
{
  if (n < 0) fail(join(what, " is ", n), "it cannot be negative");
  if (static_cast<std::size_t>(n) > remaining() / bytes_each)
    fail(join(what, " is ", n, ", but only ", remaining(), " bytes are left"),
         join("at least ", bytes_each, " bytes for each: the file is cut off or damaged"));
  return static_cast<std::size_t>(n);
}

void Scanner::fail(const std::string& found, const std::string& right) const
{
  if (is_binary_) throw FileError(join(file_, ", byte ", last_, ": ", found, "; ", right));
  const auto line = 1 + std::count(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(last_), '\n');
  throw FileError(join(file_, ':', line, ": ", found, "; ", right));
}

} // namespace mullion::mesh_files
