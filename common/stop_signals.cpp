#include <locograph/common/stop_signals.h>
#include <signal.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <string>

namespace locograph {
namespace {

constexpr std::array kStopSignals = {SIGINT, SIGTERM, SIGHUP};

/// All of it is read by a signal handler: atomics without locks, and memory that is never freed.
std::atomic<bool> requested{false};
std::atomic<int> requested_by{0};
std::atomic<int> finishing{0};

enum SlotState { kFree, kBeingNamed, kNamed };
struct NameSlot {
  std::atomic<int> state{kFree};
  std::array<char, PATH_MAX> name{};
};
std::array<NameSlot, 8> slots;

void end_by(int signal) {
  for (NameSlot& slot : slots) {
    if (slot.state.load() == kNamed) ::unlink(slot.name.data());
  }
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

void handle(int signal) {
  const int error = errno;
  if (finishing.load() > 0 && !requested.exchange(true)) {
    requested_by.store(signal);
  } else {
    end_by(signal);  // blocked as long as this runs, comes true after it
  }
  errno = error;
}

}  // namespace

void take_stop_signals() {
  for (const int signal : kStopSignals) {
    struct sigaction action = {};
    if (::sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
    action = {};
    action.sa_handler = handle;
    action.sa_flags = SA_RESTART;
    ::sigaction(signal, &action, nullptr);
  }
  ::signal(SIGXFSZ, SIG_IGN);
}

FinishOnSignal::FinishOnSignal() { ++finishing; }
FinishOnSignal::~FinishOnSignal() { --finishing; }

const std::atomic<bool>& stop_flag() { return requested; }

void end_by_stop_signal() {
  const int signal = requested_by.load();
  end_by(signal == 0 ? SIGTERM : signal);
  std::abort();  // only if the signal is blocked
}

RemovedOnSignal::RemovedOnSignal(const std::filesystem::path& file) {
  const std::string& name = file.native();
  for (std::size_t i = 0; i < slots.size() && name.size() < slots[i].name.size(); ++i) {
    int free = kFree;
    if (!slots[i].state.compare_exchange_strong(free, kBeingNamed)) continue;
    std::memcpy(slots[i].name.data(), name.c_str(), name.size() + 1);
    slots[i].state.store(kNamed);
    slot_ = static_cast<int>(i);
    return;
  }
}

RemovedOnSignal::~RemovedOnSignal() {
  if (slot_ >= 0) slots[static_cast<std::size_t>(slot_)].state.store(kFree);
}

}  // namespace locograph
