// The control object: one per run, of fixed size, written by the orchestrator alone and mapped read-only by the
// guard, the hosts and every onlooker. It says which windows and modules there are, which slot of each window is
// which level, what is being called, and carries one request slot per module. Numbers and names only.
//
// Commit: the orchestrator fills the spare one of two level tables and flips the epoch with one release store, so
// all windows commit or none does. What happens when the orchestrator dies mid-way: the epoch still names the old
// table, whole.
//
// Each host writes one small reply object of its own: the reply word, the error text, timings.
#pragma once

#include "shm/window_layout.hpp"

#include <mullion/sdk/abi.h>

#include <atomic>
#include <cstdint>
#include <string_view>
#include <sys/types.h>

namespace mullion::shm {

inline constexpr std::uint64_t control_magic = 0x31434e4f494c4c4d; // "MLLIONC1"
inline constexpr std::uint64_t reply_magic = 0x31524e4f494c4c4d;   // "MLLIONR1"
inline constexpr std::uint32_t max_modules = 16;
inline constexpr std::uint32_t max_windows = 64;
inline constexpr std::uint32_t max_parameters = 64;
inline constexpr std::uint32_t max_exchanged = 64;
inline constexpr std::uint32_t max_own_windows = 16;
inline constexpr std::uint32_t no_module = 0xffffffff;

using Word = std::atomic<std::uint32_t>;
static_assert(Word::is_always_lock_free && sizeof(Word) == 4);

// ---- levels ------------------------------------------------------------------------------------------------

/// Which slot of a window is the working level, and what the committed levels behind it are stamped with.
/// Level -k lies in slot (working_slot + n_slots - k) mod n_slots.
struct LevelEntry {
  std::uint32_t working_slot, n_slots;
  mullion_stamp committed[MULLION_MAX_LEVELS]; ///< [k - 1]: the stamp of level -k
};
struct LevelTable {
  LevelEntry windows[max_windows];
};
/// The working level of a window within the running step; changes without a commit.
struct WorkingLevel {
  mullion_stamp stamp;
  std::uint32_t is_written, reserved;
};

constexpr std::uint32_t slot_of(const LevelEntry& entry, int level)
{
  return (entry.working_slot + entry.n_slots - static_cast<std::uint32_t>(level)) % entry.n_slots;
}

// ---- windows and modules -----------------------------------------------------------------------------------

enum class Owner : std::uint32_t { module = 0, orchestrator = 1 };

struct WindowRecord {
  char name[MULLION_MAX_NAME]; ///< "structure/wet", "structure/wet.in", "driver/state"
  Owner owner;
  std::uint32_t module; ///< the owner, or the receiver of a companion; no_module for driver/state
  std::int32_t fd;      ///< of the orchestrator
  std::uint32_t generation;
  std::uint64_t bytes;
};

/// A parameter as the module gets it; texts lie in ModuleRecord::text.
struct ParameterRecord {
  double real;
  std::int64_t integer;
  std::uint32_t text_offset, reserved;
};

/// park: give up the right to write the own windows, so that another carrier of the module can have it; resume: take
/// it (back). attach_beside: park, answer, so that the slot is free for the carrier at work, and only then attach; the
/// end of that is told by the reply word too, as the number of the request with `attached_beside` flipped, and
/// results[0] says whether the attach looked at data of a level.
enum class Operation : std::uint32_t {
  none,
  create,
  define,
  attach,
  start,
  seal,
  step,
  call,
  quit,
  park,
  resume,
  attach_beside
};
inline constexpr std::uint32_t attached_beside = 1u << 31;

enum RequestFlag : std::uint32_t {
  arm_state = 1,    ///< copy carried state from level -1 (the first act of a step)
  poison = 2,       ///< fill what is not carried with NaN first (--replay)
  check_written = 4 ///< afterwards no entry may still hold the poison
};

/// One call. The word is the last thing written; the host waits on it.
struct alignas(64) Request {
  Word word; ///< number of the request
  Operation operation;
  std::uint32_t function, incarnation;
  std::uint64_t epoch;
  mullion_step step;
  std::uint32_t flags, reserved;
  double arguments[MULLION_MAX_ARGUMENTS];
};

/// A field that other parties read: checked for finite values when a step is done.
struct ExchangedField {
  std::uint32_t window, field;
};

struct ModuleRecord {
  char name[MULLION_MAX_NAME]; ///< the instance
  char kind[MULLION_MAX_NAME];
  char plugin[MULLION_MAX_NAME];
  char path[1024];
  std::uint32_t is_inline;
  std::int32_t pid;      ///< of its host; 0: none
  std::int32_t reply_fd; ///< of the orchestrator
  std::uint32_t incarnation;
  std::uint32_t n_parameters, n_exchanged;
  ParameterRecord parameters[max_parameters];
  char text[8192];
  ExchangedField exchanged[max_exchanged];
  char interface_window[MULLION_MAX_NAME]; ///< the window named in [coupling] interfaces, "" if none
  struct History {
    char window[MULLION_MAX_NAME];
    std::uint32_t n_slots, reserved;
  } histories[max_own_windows]; ///< windows that keep more than two slots
  std::uint32_t n_histories, reserved;
  Request request;
};

/// What the orchestrator is doing, for a post-mortem. `module` is no_module between calls.
struct CurrentCall {
  std::uint32_t module;
  Operation operation;
  std::uint32_t function, reserved;
  std::int64_t step;
  double time;
};

/// done: the orchestrator came to its regular end; interrupted: a second signal ended it.
enum class RunState : std::uint32_t { starting, running, interrupted, done };

struct Control {
  std::uint64_t magic;
  std::uint32_t version;
  std::uint32_t bytes;
  char run_name[MULLION_MAX_NAME];
  std::int32_t guard_pid, orchestrator_pid;
  std::atomic<RunState> state;
  std::uint32_t n_modules, n_windows;
  std::uint32_t replay;
  std::atomic<std::int64_t> step, n_steps; ///< committed so far, and planned
  std::atomic<double> time;
  CurrentCall current;
  char outcome_file[1024]; ///< run.json, which the guard completes if the orchestrator dies
  alignas(64) Word orchestrator_asleep;
  alignas(64) std::atomic<std::uint64_t> epoch; ///< commits so far; its lowest bit names the valid table
  LevelTable levels[2];
  WorkingLevel working[max_windows];
  WindowRecord windows[max_windows];
  ModuleRecord modules[max_modules];

  [[nodiscard]] const LevelTable& table(std::uint64_t at_epoch) const { return levels[at_epoch & 1]; }
  [[nodiscard]] std::uint32_t find_window(std::string_view name) const
  {
    for (std::uint32_t w = 0; w < n_windows; ++w)
      if (name == windows[w].name) return w;
    return no_window;
  }
};

// ---- replies -----------------------------------------------------------------------------------------------

/// A window that a module made in define: the host's descriptor, which the orchestrator adopts.
struct DefinedWindow {
  char name[MULLION_MAX_NAME];
  std::int32_t fd;
  std::uint32_t n_slots;
  std::uint64_t bytes;
};

struct Reply {
  std::uint64_t magic;
  std::uint32_t incarnation, reserved;
  alignas(64) Word word; ///< number of the request that is answered
  alignas(64) Word asleep;
  std::int32_t status; ///< mullion_status
  std::uint32_t n_windows;
  std::uint64_t work_ns; ///< spent in the module, arming and checking included
  double results[MULLION_MAX_ARGUMENTS];
  DefinedWindow windows[max_own_windows];
  char error[8192];
};

/// Check an attached control object. @throws Error Errc::memory
const Control& checked_control(const std::byte* object, std::uint64_t bytes);

/// Before a start-up is done again: no windows, no modules. Numbers of requests and incarnations go on, so that what an
/// earlier host left is not taken for an answer.
void forget_windows_and_modules(Control& control);

/// Copy a name into a fixed array, with a clear error if it does not fit. @throws Error Errc::config
void copy_text(char* to, std::size_t capacity, std::string_view text, std::string_view what);

const char* to_string(Operation operation);

} // namespace mullion::shm
