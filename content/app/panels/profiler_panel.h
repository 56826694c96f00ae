#pragma once

#include "content/app/bench/frame_statistics.h"
#include "render/render_frame.h"

#include <cstddef>
#include <string>
#include <vector>

namespace limn {

class FrameGraph;
struct HudStyle;
class Schedule;
class World;

/// The profiler's input, once per frame.
struct FrameCost {
    double frame_ms = 0.0;     ///< between consecutive frames
    double simulate_ms = 0.0;  ///< all systems, all steps of the frame
    double render_ms = 0.0;    ///< CPU time of drawing
    FrameStatistics statistics;
};

// F3: shows where a frame's time goes. Systems and passes with their times on the CPU and the GPU,
// a graph of the last seconds, counts and memory. Collecting costs a few additions per frame.

class ProfilerPanel {
  public:
    void add_frame(const FrameCost& cost);
    void draw(
        const HudStyle& style, const World& world, const Schedule& schedule,
        const FrameGraph& graph);

    /// Over about the last second [ms].
    [[nodiscard]] double median_frame_ms() const { return summary_.median; }

    bool open = false;

  private:
    void draw_graph(const HudStyle& style);
    void draw_counts(const HudStyle& style, const World& world, const FrameGraph& graph);
    void draw_systems(const HudStyle& style, const Schedule& schedule);
    void draw_passes(const HudStyle& style, const FrameGraph& graph);

    static constexpr std::size_t kGraphFrames = 240;
    FrameHistory history_{kGraphFrames};
    FrameHistory recent_{60};
    Summary summary_;
    FrameCost cost_;
    std::vector<double> system_ms_;  ///< smoothed, in the order of the schedule
    int compiled_ = 0;               ///< programs, in all frames so far
    double resident_mib_ = 0.0;
    int frames_until_memory_ = 0;
};

/// Resident memory of this process [MiB]; 0 if unknown.
[[nodiscard]] double resident_memory_mib();

/// Allocated heap memory of the process [MiB]: malloc, all threads.
[[nodiscard]] double heap_memory_mib();

}  // namespace limn
