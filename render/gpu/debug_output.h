#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace limn::gpu {

// OpenGL's debug messages (KHR_debug). Errors, undefined behavior and anything of high severity are
// counted, kept and logged; the rest (performance hints, notes) is dropped. Shader compilers report
// through Result instead, so their messages are ignored here.
//
// In a debug context the message comes from within the faulty call: break on `log_error` to see the
// stack.

class DebugOutput {
  public:
    /// Installs its callback in the current context; the destructor restores the previous one.
    explicit DebugOutput(bool synchronous);
    ~DebugOutput();
    DebugOutput(const DebugOutput&) = delete;
    DebugOutput& operator=(const DebugOutput&) = delete;

    /// Errors since the start.
    [[nodiscard]] std::uint64_t error_count() const;
    /// Returns and clears the messages kept since the last call, at most 64.
    std::vector<std::string> take_errors();
    /// While muted, errors are counted and kept but not logged: for tests that provoke one.
    void set_muted(bool muted);

    struct State;

  private:
    std::unique_ptr<State> state_;
};

}  // namespace limn::gpu
