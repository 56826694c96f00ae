#pragma once

#include "ecs/base/result.h"

#include <cstdint>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace limn {

struct FarmJob;

// What is known of frames and nodes: small files, each written in one step.
//
//     state/012/0012345.json   a frame that is done, or was tried: FrameState
//     state/012/0012345.claim  the worker that renders it now; removed when it ends
//     state/012/0012345.verify its second rendering: FrameState
//     workers/NODE.PID.json    a process; its time of modification says when it was last alive
//     nodes/NODE/12345         a frame that failed there; nodes/NODE/refused: why it may not work;
//                              nodes/NODE/lost_PID: a process that ended without a word
//
// A claim whose worker was not alive for kDeadSeconds is void. Times are the file system's, so that
// clocks of nodes need not agree.

inline constexpr double kAliveSeconds = 2;  ///< a worker renews its file so often
inline constexpr double kDeadSeconds = 15;  ///< and is taken for dead after that
inline constexpr int kBadNodeFrames = 3;    ///< failed frames after which a node is left out

/// One rendering of a frame, or its failure.
struct FrameAttempt {
    std::string node;         ///< name
    std::string renderer;     ///< GL_RENDERER, with the vector width of a software one
    double seconds = 0;       ///< for the frame alone
    double load_seconds = 0;  ///< before the chunk's first frame, for that one only
    int peak_mib = 0;         ///< most memory of its process
    std::string log;          ///< file below log/
    std::string why;          ///< it failed; empty: it did not
};

struct FrameState {
    int frame = 0;
    bool done = false;         ///< its file was whole, with these hashes
    std::uint64_t pixels = 0;  ///< of the decoded image
    std::uint64_t world = 0;   ///< of the simulation's state
    double psnr = 0;           ///< a second rendering with other pixels: from the first [dB]
    double largest = 0;        ///< and the largest difference of a channel, 0 .. 1, as displayed
    std::vector<FrameAttempt> attempts;  ///< in order; the last one is the one that is done
};

/// What kind of file a state has.
enum class StateFile { Frame, Verify };

/// No file: no attempts. One that cannot be read counts as none, too: the frame is rendered again.
[[nodiscard]] FrameState
read_frame_state(const FarmJob& job, int frame, StateFile kind = StateFile::Frame);
/// Of all frames of the job, in their order.
[[nodiscard]] std::vector<FrameState> read_all_states(const FarmJob& job);
[[nodiscard]] Status
write_frame_state(const FarmJob& job, const FrameState& state, StateFile kind = StateFile::Frame);

/// Its attempts have failed as often as the job allows.
[[nodiscard]] bool is_given_up(const FarmJob& job, const FrameState& state);

/// Nodes on which attempts failed, each once.
[[nodiscard]] std::vector<std::string> failed_nodes(const FrameState& state);

/// A process that works on a job, while it lives; its file is workers/ID.json.
struct FarmWorker {
    std::string id;            ///< NODE.PID
    std::string node;          ///< name
    int pid = 0;               ///< there
    int current = -1;          ///< frame that is being drawn; -1: loading
    std::vector<int> chunk;    ///< its frames
    double alive_seconds = 0;  ///< since its file was renewed; read only
    bool dead = false;         ///< not renewed for kDeadSeconds, or known to have ended; read only
};
[[nodiscard]] FarmWorker make_worker(std::vector<int> chunk);
[[nodiscard]] Status write_worker(const FarmJob& job, const FarmWorker& worker);
/// Renews a worker's file every kAliveSeconds, on a thread of its own.
class Heartbeat {
  public:
    Heartbeat(const FarmJob& job, const FarmWorker& worker);

  private:
    std::jthread thread_;
};
/// Gives up its claims, and removes its file.
void remove_worker(const FarmJob& job, const FarmWorker& worker);
/// All, by id; those that are dead, too.
[[nodiscard]] std::vector<FarmWorker> list_workers(const FarmJob& job);

/// Whether the frame is this worker's from now on: it was free, or its worker is dead.
[[nodiscard]] bool
claim_frame(const FarmJob& job, const FarmWorker& worker, int frame, StateFile kind);
void release_frame(const FarmJob& job, int frame, StateFile kind);

/// The same for the job itself: who starts its workers. False: another process does.
[[nodiscard]] bool claim_job(const FarmJob& job, const FarmWorker& coordinator);
void release_job(const FarmJob& job, const FarmWorker& coordinator);
/// Who has claimed the job, if it lives.
[[nodiscard]] std::optional<FarmWorker> find_coordinator(const FarmJob& job);

/// Removes a frame's state, so that it is rendered as if it had never been.
void forget_frame(const FarmJob& job, int frame);

/// What a job knows of a node.
struct FarmNode {
    std::string name;
    std::vector<int> failed;  ///< frames, rising
    int lost = 0;         ///< processes that ended without a word: killed, or the node with them
    std::string refused;  ///< why it may not work: another program, other inputs; empty: it may
    [[nodiscard]] bool left_out() const {
        return !refused.empty() || static_cast<int>(failed.size()) >= kBadNodeFrames;
    }
};
void note_failure(const FarmJob& job, const std::string& node, int frame);
void note_refusal(const FarmJob& job, const std::string& node, const std::string& why);
/// Removes the files of dead workers, and notes them as lost.
void bury_dead_workers(const FarmJob& job);
[[nodiscard]] FarmNode read_node(const FarmJob& job, const std::string& name);
/// All with notes, by name.
[[nodiscard]] std::vector<FarmNode> list_nodes(const FarmJob& job);

/// `limn farm cancel` was given; workers end.
[[nodiscard]] bool is_cancelled(const FarmJob& job);

}  // namespace limn
