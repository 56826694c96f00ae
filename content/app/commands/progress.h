#pragma once

#include <chrono>
#include <string>

namespace limn {

/// "frame 12 of 100 [#####-----] 8 s left" on stderr, redrawn in place at most ten times a second.
/// Prints nothing unless stderr is a terminal, so logs stay clean. The destructor clears the line.
class Progress {
  public:
    /// `what` names the unit counted, e.g. "frame"; `total` of them make 100 %. Not `shown`: prints
    /// nothing.
    Progress(std::string what, int total, bool shown = true);
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress();

    /// `done` of the total are finished.
    void update(int done);

  private:
    using Clock = std::chrono::steady_clock;
    std::string what_;
    int total_ = 0;
    bool on_terminal_ = false;
    bool drawn_ = false;
    Clock::time_point begin_;
    Clock::time_point last_draw_;
};

}  // namespace limn
