#pragma once

#include "content/app/farm/farm_job.h"
#include "content/app/farm/farm_state.h"

#include <string>
#include <vector>

namespace limn {

/// A frame that is not there, and why.
struct FailedFrame {
    int frame = 0;
    int tries = 0;                   ///< attempts
    std::vector<std::string> nodes;  ///< on which it failed
    std::string why;                 ///< the last attempt's
};

/// What a node has done so far.
struct NodeStatus {
    FarmNode node;
    std::string renderer;      ///< of its last frame
    int done = 0;              ///< frames
    double seconds = 0;        ///< for them
    int peak_mib = 0;          ///< most memory of a process
    std::vector<int> drawing;  ///< frames, now
    bool loading = false;      ///< a process of it lives and draws none of them
};

/// A job, as its files say.
struct FarmStatus {
    int total = 0;
    int done = 0;
    int running = 0;  ///< being drawn now, or loaded for
    int failed = 0;   ///< given up
    [[nodiscard]] int waiting() const { return total - done - running - failed; }
    double frame_seconds = 0;  ///< mean of a frame
    double load_seconds = 0;   ///< mean before a chunk's first frame
    double left_seconds = -1;  ///< until all are done; -1: not known
    int good_chunk = 0;        ///< frames a chunk with which loading costs a tenth; 0: not known
    bool cancelled = false;
    bool coordinated = false;              ///< a process, or the queue of Slurm, goes on with it
    std::vector<NodeStatus> nodes;         ///< by name
    std::vector<FailedFrame> given_up;     ///< by frame: will not be tried again
    std::vector<FailedFrame> to_retry;     ///< by frame: will be
    int to_verify = 0;                     ///< frames that are to be rendered twice
    int verified = 0;                      ///< those that were
    std::vector<std::string> differences;  ///< what those found, a line each
    int verified_here = 0;                 ///< of them on the same node: no other was there
    std::string suspect;                   ///< the node in more of them than any other; empty: none
    int verified_bits = 0;                 ///< of them equal bit for bit
};

/// Whether one of FarmStatus::differences is an error, not another renderer's rounding.
[[nodiscard]] bool must_not_differ(const std::string& difference);

[[nodiscard]] FarmStatus read_farm_status(const FarmJob& job);

/// Lines for a person. `brief`: one line, without nodes.
[[nodiscard]] std::string describe_status(const FarmJob& job, const FarmStatus& status);
[[nodiscard]] std::string summarize_status(const FarmJob& job, const FarmStatus& status);

/// The same as JSON.
[[nodiscard]] std::string status_json(const FarmJob& job, const FarmStatus& status);

}  // namespace limn
