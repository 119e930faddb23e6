#include "log/console.hpp"

#include <mullion/sdk/abi.h>

#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <memory>
#include <mutex>

namespace mullion::log {
namespace {

/// Writes to standard error and keeps the progress line below everything else.
class ConsoleSink final : public spdlog::sinks::base_sink<std::mutex> {
public:
  explicit ConsoleSink(bool is_terminal) : is_terminal_(is_terminal) {}

  void show_progress(const std::string& line)
  {
    const std::lock_guard lock(mutex_);
    if (!is_terminal_ || line == progress_) return;
    progress_ = line;
    put("\r\x1b[K" + progress_);
  }
  [[nodiscard]] bool is_terminal() const { return is_terminal_; }

private:
  void sink_it_(const spdlog::details::log_msg& message) override
  {
    spdlog::memory_buf_t text;
    formatter_->format(message, text);
    std::string out = progress_.empty() ? "" : "\r\x1b[K";
    out.append(text.data(), text.size());
    put(out + progress_);
  }
  void flush_() override { std::fflush(stderr); }
  static void put(const std::string& text)
  {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
  }
  bool is_terminal_;
  std::string progress_;
};

std::shared_ptr<ConsoleSink> sink;
std::shared_ptr<spdlog::logger> logger;

spdlog::level::level_enum to_spdlog(Level level)
{
  switch (level) {
  case Level::debug: return spdlog::level::debug;
  case Level::info: return spdlog::level::info;
  case Level::warning: return spdlog::level::warn;
  case Level::error: return spdlog::level::err;
  case Level::off: break;
  }
  return spdlog::level::off;
}

} // namespace

bool parse_level(std::string_view name, Level& level)
{
  constexpr std::pair<std::string_view, Level> levels[] = {{"debug", Level::debug},
                                                           {"info", Level::info},
                                                           {"warning", Level::warning},
                                                           {"error", Level::error},
                                                           {"off", Level::off}};
  for (const auto& [text, value] : levels)
    if (text == name) {
      level = value;
      return true;
    }
  return false;
}

Level level_of(std::uint32_t number)
{
  switch (number) {
  case MULLION_DEBUG: return Level::debug;
  case MULLION_WARNING: return Level::warning;
  case MULLION_ERROR: return Level::error;
  default: return Level::info;
  }
}

void initialise(Level level, bool is_terminal)
{
  sink = std::make_shared<ConsoleSink>(is_terminal);
  logger = std::make_shared<spdlog::logger>("mullion", sink);
  logger->set_pattern("%H:%M:%S.%e %l %v");
  logger->set_level(to_spdlog(level));
}

void write(Level level, std::string_view source, std::string_view text)
{
  if (logger == nullptr) return;
  for (;;) { // each line of the text gets the name
    const auto end = text.find('\n');
    logger->log(to_spdlog(level), "{}: {}", source, text.substr(0, end));
    if (end == std::string_view::npos) return;
    text.remove_prefix(end + 1);
  }
}

bool is_terminal() { return sink != nullptr && sink->is_terminal(); }

void show_progress(const std::string& line)
{
  if (sink != nullptr) sink->show_progress(line);
}

} // namespace mullion::log
