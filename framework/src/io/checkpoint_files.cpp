#include "io/checkpoint_files.hpp"

#include "io/checkpoint_trial.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <charconv>
#include <string_view>

namespace mullion::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view prefix = "checkpoint-", suffix = ".h5";

} // namespace

std::string checkpoint_name(std::int64_t step) { return fmt::format("{}{:09}{}", prefix, step, suffix); }

std::vector<CheckpointFile> list_checkpoints(const fs::path& folder)
{
  std::vector<CheckpointFile> found;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const auto name = entry.path().filename().string();
    if (!name.starts_with(prefix) || !name.ends_with(suffix)) continue;
    const char *begin = name.data() + prefix.size(), *end = name.data() + name.size() - suffix.size();
    std::int64_t step = 0;
    const auto parsed = std::from_chars(begin, end, step);
    if (parsed.ec == std::errc{} && parsed.ptr == end && checkpoint_name(step) == name)
      found.push_back({entry.path(), step});
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.step > b.step; });
  return found;
}

std::optional<CheckpointFile> newest_good_checkpoint(const fs::path& folder, std::vector<std::string>* problems)
{
  for (const auto& file : list_checkpoints(folder)) {
    try {
      try_checkpoint(file.path);
      return file;
    } catch (const Error& error) {
      if (problems != nullptr) problems->emplace_back(error.what());
    }
  }
  return std::nullopt;
}

void keep_newest_checkpoints(const fs::path& folder, std::int64_t n, std::int64_t step) noexcept
{
  if (n <= 0) return;
  try {
    auto files = list_checkpoints(folder);
    std::erase_if(files, [&](const auto& file) { return file.step > step; });
    std::error_code ignored;
    for (auto i = static_cast<std::size_t>(n); i < files.size(); ++i) fs::remove(files[i].path, ignored);
  } catch (const std::exception&) {
    // too many are no harm
  }
}

void remove_checkpoints_after(const fs::path& folder, std::int64_t step) noexcept
{
  try {
    std::error_code ignored;
    for (const auto& file : list_checkpoints(folder))
      if (file.step > step) fs::remove(file.path, ignored);
  } catch (const std::exception&) {
    // a folder that cannot be listed gets no new ones either
  }
}

} // namespace mullion::io
