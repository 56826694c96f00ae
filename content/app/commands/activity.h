#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace limn {

/// "drawing gallery, 4 s" on stderr while something takes longer than a second, redrawn in place.
/// Prints nothing unless stderr is a terminal. For work without countable steps; with them,
/// Progress shows how much is left. Use only one of the two at a time.
class Activity {
  public:
    /// `what` names the work. Not `shown`: prints nothing.
    explicit Activity(std::string what, bool shown = true);
    Activity(const Activity&) = delete;
    Activity& operator=(const Activity&) = delete;
    /// Clears the line.
    ~Activity();

  private:
    void draw_until_done();

    using Clock = std::chrono::steady_clock;
    Clock::time_point begin_ = Clock::now();
    std::mutex mutex_;
    std::condition_variable done_changed_;
    std::string what_;
    bool done_ = false;  ///< guarded by mutex_
    std::thread thread_;
};

}  // namespace limn
