// The parts of `limn farm`: lists of frames, the files of a job, claims, rounds. tests/farm.sh runs
// whole jobs, on Slurm and over ssh.

#include "content/app/farm/child_process.h"
#include "content/app/farm/farm_check.h"
#include "content/app/farm/farm_job.h"
#include "content/app/farm/farm_run.h"
#include "content/app/farm/farm_scheduler.h"
#include "content/app/farm/farm_state.h"
#include "content/app/farm/farm_status.h"
#include "content/app/farm/frame_file.h"
#include "content/app/farm/frame_list.h"
#include "content/load/files/atomic_file.h"
#include "content/load/files/png_file.h"
#include "tests/app/run_program.h"
#include "tests/near.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>
#include <string>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace limn::farm_test {

using namespace limn::test;

namespace {

constexpr IVec2 kSize = {4, 3};

FarmJob make_job(const TemporaryFolder& folder, int frames = 40) {
    FarmJob job;
    job.folder = folder.file("job");
    job.program = program_path();
    job.program_hash = *hash_program();
    job.id = "0123456789abcdef";
    job.scene = "a.level.json";
    job.name = "frame_%03d.png";
    job.size = kSize;
    job.frames.resize(static_cast<std::size_t>(frames));
    std::iota(job.frames.begin(), job.frames.end(), 0);
    job.chunk = 4;
    REQUIRE(save_farm_job(job).ok());
    return job;
}

void write_frame(const FarmJob& job, int frame, std::uint8_t shade, const IVec2& size = kSize) {
    const std::vector<std::uint8_t> pixels(static_cast<std::size_t>(3 * size.x * size.y), shade);
    REQUIRE(write_png(frame_path(job, frame), size.x, size.y, 3, pixels).ok());
}

/// A state with attempts on these nodes; `why` empty: done.
FrameState tried(int frame, const std::vector<std::string>& nodes, const std::string& why) {
    FrameState state;
    state.frame = frame;
    state.done = why.empty();
    for (const std::string& node : nodes) {
        FrameAttempt attempt;
        attempt.node = node;
        attempt.renderer = "software";
        attempt.seconds = 2;
        attempt.why = why;
        state.attempts.push_back(attempt);
    }
    return state;
}

void finish_frame(const FarmJob& job, int frame, const std::string& node) {
    write_frame(job, frame, 77);
    FrameState state = tried(frame, {node}, "");
    state.pixels = read_frame_file(frame_path(job, frame), kSize)->pixels;
    REQUIRE(write_frame_state(job, state).ok());
}

std::vector<int> frames_of(const std::vector<FarmGroup>& groups) {
    std::vector<int> frames;
    for (const FarmGroup& group : groups) {
        for (const std::vector<int>& chunk : group.chunks) {
            frames.insert(frames.end(), chunk.begin(), chunk.end());
        }
    }
    std::ranges::sort(frames);
    return frames;
}

void set_age(const std::string& path, int seconds) {
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    now.tv_sec -= seconds;
    const timespec times[2] = {now, now};
    REQUIRE(::utimensat(AT_FDCWD, path.c_str(), times, 0) == 0);
}

}  // namespace

TEST_CASE("farm: lists of frames are read and written") {
    CHECK(*parse_frame_list("7") == std::vector{7});
    CHECK(*parse_frame_list("2:5") == std::vector{2, 3, 4, 5});
    CHECK(*parse_frame_list("0:9:4") == std::vector{0, 4, 8});
    CHECK(*parse_frame_list("5,0:2,1:3") == std::vector{0, 1, 2, 3, 5});
    for (const char* const bad : {"", ":", "3:1", "0:9:0", "a", "0:1:2:3", "0,,1", "-1", "0:9:x"}) {
        CAPTURE(bad);
        CHECK_FALSE(parse_frame_list(bad).ok());
    }
    CHECK(write_frame_list({0, 1, 2, 3}) == "0:3");
    CHECK(write_frame_list({0, 4, 8, 9}) == "0:8:4,9");
    CHECK(write_frame_list({0, 4}) == "0,4");
    // Whatever the list, what is written is read as the same.
    std::uint64_t state = 1;
    for (int round = 0; round < 200; ++round) {
        std::vector<int> frames;
        for (int frame = 0; frame < 60; ++frame) {
            state = state * 6364136223846793005ull + 1442695040888963407ull;
            if ((state >> 60) < 5) {
                frames.push_back(frame);
            }
        }
        if (!frames.empty()) {
            CHECK(*parse_frame_list(write_frame_list(frames)) == frames);
        }
    }
}

TEST_CASE("farm: chunks have all frames once; preview begins with every 16th") {
    std::vector<int> frames(50);
    std::iota(frames.begin(), frames.end(), 3);
    for (const FrameOrder order : {FrameOrder::Plain, FrameOrder::Preview}) {
        std::vector<int> all;
        for (const std::vector<int>& chunk : make_chunks(frames, 7, order)) {
            CHECK(chunk.size() <= 7);
            CHECK(std::ranges::is_sorted(chunk));
            all.insert(all.end(), chunk.begin(), chunk.end());
        }
        CHECK(std::is_sorted(all.begin(), all.end()) == (order == FrameOrder::Plain));
        std::ranges::sort(all);
        CHECK(all == frames);
    }
    CHECK(make_chunks(frames, 7, FrameOrder::Preview)[0] == std::vector{3, 19, 35, 51});
}

TEST_CASE("farm: job.json is read as it was written, also from another folder") {
    const TemporaryFolder folder;
    FarmJob job = make_job(folder);
    job.render = {"--spp=4", "--set=exposure.ev=1"};
    job.hosts = {"a", "b c"};
    job.scheduler = FarmScheduler::Slurm;
    job.order = FrameOrder::Preview;
    job.verify = 0.05;
    job.memory_mib = 900;
    job.scene_sound = job.whole_sound = true;
    job.inputs = {{"a/b.png", 0xfedcba9876543210ull, 12}};
    REQUIRE(save_farm_job(job).ok());
    std::filesystem::rename(job.folder, folder.file("moved"));
    const Result<FarmJob> read = load_farm_job(folder.file("moved"));
    REQUIRE(read.ok());
    CHECK(read->folder == folder.file("moved"));
    CHECK(read->frames == job.frames);
    CHECK(read->render == job.render);
    CHECK(read->hosts == job.hosts);
    CHECK(read->scheduler == job.scheduler);
    CHECK(read->order == job.order);
    CHECK(read->verify == job.verify);
    CHECK(read->memory_mib == 900);
    CHECK(read->scene_sound);
    CHECK(read->whole_sound);
    CHECK(read->program_hash == job.program_hash);
    CHECK(read->inputs[0].hash == job.inputs[0].hash);
}

TEST_CASE("farm: a bad job.json is refused with file, what was found and what was expected") {
    const TemporaryFolder folder;
    const FarmJob job = make_job(folder);
    const std::string path = job.folder + "/job.json";
    const std::string good = read_text(path);
    struct Change {
        const char* from;
        const char* to;
        const char* error;
    };
    for (const Change& change :
         {Change{"\"chunk\": 4", "\"chunk\": 0", "found chunk 0"},
          Change{
              "\"chunk\": 4", "\"chunk\": \"x\"", "\"chunk\": found string, expected another type"},
          Change{
              "\"scheduler\": \"local\"", "\"scheduler\": \"cron\"",
              "expected one of local parallel slurm"},
          Change{"\"frames\": \"0:39\"", "\"frames\": \"9:1\"", "9:1"},
          Change{"frame_%03d.png", "../%03d.png", "name: found"},
          Change{
              "\"inputs\": []",
              "\"inputs\": [{\"path\": \"../a\", \"hash\": \"0123456789abcdef\", \"bytes\": 1}]",
              "below inputs/"},
          Change{"\"limn_farm\": 1", "\"limn_farm\": 2", "expected 1"},
          Change{"\"timeout\"", "\"time\"", "found no \"timeout\""}}) {
        CAPTURE(change.to);
        std::string bad = good;
        const std::size_t at = bad.find(change.from);
        REQUIRE(at != std::string::npos);
        bad.replace(at, std::string(change.from).size(), change.to);
        write_text(path, bad);
        const Result<FarmJob> read = load_farm_job(job.folder);
        REQUIRE_FALSE(read.ok());
        CHECK(read.error().message.find(change.error) != std::string::npos);
        CHECK(read.error().message.find("job.json: ") != std::string::npos);
    }
    write_text(path, good.substr(0, good.size() / 2));
    CHECK_FALSE(load_farm_job(job.folder).ok());
    CHECK(
        load_farm_job(folder.file("none")).error().message.find("found no job.json")
        != std::string::npos);
}

TEST_CASE("farm: inputs are copied with their hashes; a change of one is found, and named") {
    const TemporaryFolder folder;
    FarmJob job = make_job(folder);
    std::filesystem::create_directory(folder.file("maps"));
    write_text(folder.file("a.level.json"), "{}");
    write_text(folder.file("maps/b.png"), "not read");
    REQUIRE(
        freeze_inputs(
            job, folder.path(),
            {folder.file("a.level.json"), folder.file("maps/b.png"), folder.file("a.level.json")})
            .ok());
    CHECK(job.inputs.size() == 2);
    CHECK(find_difference(job).empty());
    write_text(job.folder + "/inputs/maps/b.png", "not reaD");
    CHECK(find_difference(job).find("inputs/maps/b.png: found") != std::string::npos);
    std::filesystem::remove(job.folder + "/inputs/maps/b.png");
    CHECK(find_difference(job).find("no such file") != std::string::npos);
    job.inputs.pop_back();
    CHECK(find_difference(job).empty());
    ++job.program_hash;
    CHECK(find_difference(job).find("found program") == 0);
}

TEST_CASE("farm: files that are read while a recorder exists are listed") {
    const TemporaryFolder folder;
    write_text(folder.file("a"), "1");
    write_text(folder.file("b"), "2");
    CHECK(read_file(folder.file("a")).ok());
    const ReadRecorder recorder;
    CHECK(read_file(folder.file("b")).ok());
    CHECK_FALSE(read_file(folder.file("c")).ok());
    CHECK(recorder.paths() == std::vector{folder.file("b")});
}

TEST_CASE("farm: a frame's state is read as written; a damaged one counts as none") {
    const TemporaryFolder folder;
    const FarmJob job = make_job(folder);
    FrameState state = tried(12345, {"n1", "n2"}, "");
    state.attempts[0].why = "ended by \"signal\" 9\n";
    state.pixels = 0xfedcba9876543210ull;
    state.world = 42;
    REQUIRE(write_frame_state(job, state).ok());
    const FrameState read = read_frame_state(job, 12345);
    CHECK(read.done);
    CHECK(read.pixels == state.pixels);
    CHECK(read.world == 42);
    REQUIRE(read.attempts.size() == 2);
    CHECK(read.attempts[0].why == state.attempts[0].why);
    CHECK(failed_nodes(read) == std::vector<std::string>{"n1"});
    const std::string path = job.folder + "/state/012/0012345.json";
    const std::string text = read_text(path);
    for (std::size_t length = 0; length < text.size() - 1; ++length) {
        write_text(path, text.substr(0, length));
        CHECK_FALSE(read_frame_state(job, 12345).done);
    }
    for (const char* const other :
         {"[]", "{\"done\": true}", "{\"done\": 7}", "{\"done\":true,\"attempts\":[3]}",
          "{\"done\":true,\"attempts\":{}}"}) {
        write_text(path, other);
        CHECK_FALSE(read_frame_state(job, 12345).done);
    }
}

TEST_CASE("farm: one worker has a frame, until it ends or dies") {
    const TemporaryFolder folder;
    const FarmJob job = make_job(folder);
    const FarmWorker self = make_worker({1, 2});
    FarmWorker other = self;
    other.node = "elsewhere";
    other.id = "elsewhere.1";
    other.pid = 1;
    REQUIRE(write_worker(job, self).ok());
    REQUIRE(write_worker(job, other).ok());
    CHECK(claim_frame(job, self, 1, StateFile::Frame));
    CHECK_FALSE(claim_frame(job, other, 1, StateFile::Frame));
    CHECK_FALSE(claim_frame(job, self, 1, StateFile::Frame));
    CHECK(claim_frame(job, other, 1, StateFile::Verify));  // another matter
    // A worker that removes itself gives up what it has, and nothing else.
    CHECK(claim_frame(job, other, 2, StateFile::Frame));
    remove_worker(job, self);
    CHECK(claim_frame(job, other, 1, StateFile::Frame));
    REQUIRE(write_worker(job, self).ok());
    CHECK_FALSE(claim_frame(job, self, 2, StateFile::Frame));
    // Dead on another node: after a while without a sign; here: at once.
    set_age(job.folder + "/workers/elsewhere.1.json", static_cast<int>(kDeadSeconds) - 3);
    CHECK_FALSE(claim_frame(job, self, 2, StateFile::Frame));
    set_age(job.folder + "/workers/elsewhere.1.json", static_cast<int>(kDeadSeconds) + 3);
    CHECK(claim_frame(job, self, 2, StateFile::Frame));
    FarmWorker ended = self;
    ended.id = self.node + ".999999999";
    ended.pid = 999999999;
    REQUIRE(write_worker(job, ended).ok());
    REQUIRE(claim_frame(job, ended, 3, StateFile::Frame));
    CHECK(claim_frame(job, self, 3, StateFile::Frame));
    bury_dead_workers(job);
    CHECK(list_workers(job).size() == 1);
    CHECK(read_node(job, "elsewhere").lost == 1);
}

TEST_CASE("farm: of many that want a dead worker's frame, one gets it") {
    const TemporaryFolder folder;
    const FarmJob job = make_job(folder);
    for (int round = 0; round < 20; ++round) {
        FarmWorker dead = make_worker({round});
        dead.id = dead.node + ".999999999";
        dead.pid = 999999999;
        REQUIRE(write_worker(job, dead).ok());
        REQUIRE(claim_frame(job, dead, round, StateFile::Frame));
        std::atomic<int> winners = 0;
        std::vector<std::thread> threads;
        for (int i = 0; i < 8; ++i) {
            threads.emplace_back([&, i] {
                FarmWorker worker = make_worker({round});
                worker.id += fmt::format(".{}", i);
                static_cast<void>(write_worker(job, worker).ok());
                winners += claim_frame(job, worker, round, StateFile::Frame) ? 1 : 0;
            });
        }
        for (std::thread& thread : threads) {
            thread.join();
        }
        CHECK(winners == 1);
    }
}

TEST_CASE("farm: files of a job with wrong types, or none of text, count as none") {
    const TemporaryFolder folder;
    const FarmJob job = make_job(folder);
    const FarmWorker self = make_worker({1});
    REQUIRE(write_worker(job, self).ok());
    std::filesystem::create_directories(job.folder + "/state/000");
    for (const char* const text :
         {R"({"worker": 3})", R"({"worker": []})", R"({"node": 5, "pid": "x", "chunk": 7})",
          R"({"done": true, "attempts": [{"node": 5, "seconds": "a", "why": []}], "pixels": 8})",
          "[1]", "7", "", "{\xff\xfe"}) {
        CAPTURE(text);
        for (const char* const name :
             {"/coordinator", "/workers/x.json", "/state/000/0000001.json",
              "/state/000/0000001.claim", "/state/000/0000002.verify", "/result.json"}) {
            write_text(job.folder + name, text);
        }
        const FarmStatus status = read_farm_status(job);
        CHECK(status.total == 40);
        CHECK_FALSE(describe_status(job, status).empty());
        CHECK_FALSE(status_json(job, status).empty());
        CHECK_FALSE(find_coordinator(job).has_value());
        CHECK(claim_frame(job, self, 1, StateFile::Frame));  // no living worker has it
        release_frame(job, 1, StateFile::Frame);
    }
    FrameState state = tried(3, {"n1"}, "log: \xff\xfe");  // what a program printed
    REQUIRE(write_frame_state(job, state).ok());
    CHECK(read_frame_state(job, 3).attempts.size() == 1);
}

TEST_CASE("farm: a worker gives signs of life by itself") {
    const TemporaryFolder folder;
    const FarmJob job = make_job(folder);
    FarmWorker worker = make_worker({1});
    worker.node = "elsewhere";
    worker.id = "elsewhere.1";
    REQUIRE(write_worker(job, worker).ok());
    const std::string path = job.folder + "/workers/elsewhere.1.json";
    set_age(path, 100);
    CHECK(list_workers(job)[0].dead);
    const Heartbeat heartbeat(job, worker);
    for (int i = 0; i < 100 && list_workers(job)[0].dead; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    CHECK_FALSE(list_workers(job)[0].dead);
}

TEST_CASE("farm: a round has what is missing, and sends failed frames to other nodes") {
    const TemporaryFolder folder;
    FarmJob job = make_job(folder);
    CHECK(frames_of(plan_round(job)) == job.frames);
    for (int frame = 0; frame < 30; ++frame) {
        finish_frame(job, frame, "n1");
    }
    REQUIRE(write_frame_state(job, tried(31, {"n2"}, "crashed")).ok());
    REQUIRE(write_frame_state(job, tried(32, {"n1", "n2", "n1"}, "crashed")).ok());  // given up
    const std::vector<FarmGroup> groups = plan_round(job);
    CHECK(frames_of(groups) == std::vector{30, 31, 33, 34, 35, 36, 37, 38, 39});
    const auto retried =
        std::ranges::find(groups, std::vector<std::string>{"n2"}, &FarmGroup::without);
    REQUIRE(retried != groups.end());
    CHECK(retried->chunks == std::vector<std::vector<int>>{{31}});
}

TEST_CASE(
    "farm: when all is done, the asked share is rendered again without the node that did it") {
    const TemporaryFolder folder;
    FarmJob job = make_job(folder);
    job.verify = 0.1;
    CHECK(frames_to_verify(job) == std::vector{5, 15, 25, 35});
    for (const int frame : job.frames) {
        finish_frame(job, frame, frame < 20 ? "n1" : "n2");
    }
    const std::vector<FarmGroup> groups = plan_round(job);
    CHECK(frames_of(groups) == std::vector{5, 15, 25, 35});
    for (const FarmGroup& group : groups) {
        CHECK(group.kind == StateFile::Verify);
        const std::vector<int> frames = frames_of({group});
        CHECK(group.without == std::vector<std::string>{frames[0] < 20 ? "n1" : "n2"});
    }
    for (const int frame : frames_to_verify(job)) {
        REQUIRE(write_frame_state(job, tried(frame, {"n3"}, ""), StateFile::Verify).ok());
    }
    CHECK(plan_round(job).empty());
    for (const double share : {0.0, 0.001, 0.5, 1.0}) {
        job.verify = share;
        CHECK(frames_to_verify(job).size() == static_cast<std::size_t>(std::ceil(40 * share)));
    }
}

TEST_CASE("farm: chunks of a plan are read as written") {
    const TemporaryFolder folder;
    const FarmJob job = make_job(folder);
    FarmGroup group;
    group.kind = StateFile::Verify;
    group.chunks = {{0, 1, 2}, {5}, {7, 9, 11}};
    const std::string path = *write_plan(job, "0001_0", group);
    for (std::size_t i = 0; i < group.chunks.size(); ++i) {
        const Result<PlannedChunk> chunk = read_plan(path, static_cast<int>(i) + 1);
        REQUIRE(chunk.ok());
        CHECK(chunk->kind == StateFile::Verify);
        CHECK(chunk->frames == group.chunks[i]);
    }
    CHECK_FALSE(read_plan(path, 4).ok());
    CHECK_FALSE(read_plan(folder.file("none"), 1).ok());
}

TEST_CASE("farm: status says what is done, running, failed, and by whom") {
    const TemporaryFolder folder;
    const FarmJob job = make_job(folder);
    for (int frame = 0; frame < 10; ++frame) {
        finish_frame(job, frame, frame < 6 ? "n1" : "n2");
    }
    REQUIRE(write_frame_state(job, tried(11, {"n1", "n2", "n1"}, "no progress for 9 s")).ok());
    for (const int frame : {11, 12, 13}) {
        note_failure(job, "n2", frame);
    }
    note_refusal(job, "n3", "found program 1, expected 2");
    FarmWorker worker = make_worker({14, 15});
    worker.current = 14;
    REQUIRE(write_worker(job, worker).ok());
    const FarmStatus status = read_farm_status(job);
    CHECK(status.total == 40);
    CHECK(status.done == 10);
    CHECK(status.running == 1);
    CHECK(status.failed == 1);
    CHECK(status.waiting() == 28);
    CHECK(status.frame_seconds == near(2));
    CHECK(status.left_seconds == near(2 * 28.5));
    CHECK_FALSE(status.coordinated);
    const std::string text = describe_status(job, status);
    for (const char* const part :
         {"10 of 40 frames done, 1 running, 1 failed, 28 waiting", "57.0 s left",
          "frame 11: failed 3 times, on n1, n2: no progress for 9 s",
          "failed 11 12 13; left out: 3 frames failed there",
          "left out: found program 1, expected 2", "draws 14", "limn farm resume does"}) {
        CAPTURE(part);
        CHECK(text.find(part) != std::string::npos);
    }
    CHECK(status_json(job, status).find("\"left_out\": true") != std::string::npos);
}

TEST_CASE(
    "farm: second renderings must have the same state, and the same bits on the same renderer") {
    const TemporaryFolder folder;
    FarmJob job = make_job(folder, 1);
    job.verify = 1;
    finish_frame(job, 0, "n1");
    FrameState second = read_frame_state(job, 0);
    second.attempts[0].node = "n2";
    const auto difference = [&] {
        REQUIRE(write_frame_state(job, second, StateFile::Verify).ok());
        const FarmStatus status = read_farm_status(job);
        CHECK(status.verified == 1);
        return status.differences.empty() ? std::string() : status.differences[0];
    };
    CHECK(difference().empty());
    second.pixels += 1;
    second.psnr = 80;
    second.largest = 0.004;
    CHECK(
        difference()
        == "frame 0: n1 and n2: found pixels 80.0 dB from each other, at most 0.0040, expected the "
           "same bits (software)");
    second.attempts[0].renderer = "hardware";
    CHECK(
        difference()
        == "frame 0: n1 and n2: pixels 80.0 dB from each other, at most 0.0040, as they may be "
           "(software and hardware)");
    second.psnr = 30;
    CHECK(difference().find("expected 40 dB or more") != std::string::npos);
    second.world += 1;
    CHECK(
        difference().find("other states of the simulation, expected the same")
        != std::string::npos);
}

TEST_CASE("farm: the node whose renderings differ from those of several others is named") {
    const TemporaryFolder folder;
    FarmJob job = make_job(folder, 4);
    job.verify = 1;
    REQUIRE(save_farm_job(job).ok());
    const char* const nodes[][2] = {{"n1", "n3"}, {"n3", "n2"}, {"n1", "n2"}, {"n2", "n1"}};
    for (const int frame : job.frames) {
        finish_frame(job, frame, nodes[frame][0]);
        FrameState second = read_frame_state(job, frame);
        second.attempts[0].node = nodes[frame][1];
        second.pixels += frame < 2 ? 1 : 0;  // those with n3
        second.psnr = 80;
        REQUIRE(write_frame_state(job, second, StateFile::Verify).ok());
    }
    const FarmStatus status = read_farm_status(job);
    CHECK(status.differences.size() == 2);
    CHECK(status.suspect == "n3");
    const Status checked = run_farm_check(job.folder, true);
    REQUIRE_FALSE(checked.ok());
    CHECK(checked.error().message.find("most of them with n3") != std::string::npos);
    job.frames = {0};
    CHECK(read_farm_status(job).suspect.empty());  // either may be wrong
}

TEST_CASE(
    "farm: check finds frames that are missing, empty, cut off, of another size or another image") {
    const TemporaryFolder folder;
    const FarmJob job = make_job(folder, 8);
    for (const int frame : job.frames) {
        finish_frame(job, frame, "n1");
    }
    CHECK(check_frames(job).empty());
    std::filesystem::remove(frame_path(job, 0));
    write_text(frame_path(job, 1), "");
    const std::string whole = read_text(frame_path(job, 2));
    write_text(frame_path(job, 2), whole.substr(0, whole.size() - 9));
    write_frame(job, 3, 77, {4, 4});
    write_frame(job, 4, 78);
    forget_frame(job, 5);
    const std::vector<FrameProblem> problems = check_frames(job);
    std::vector<int> frames;
    std::ranges::transform(problems, std::back_inserter(frames), &FrameProblem::frame);
    CHECK(frames == std::vector{0, 1, 2, 3, 4, 5});
    CHECK(problems[0].what.find("no such file") != std::string::npos);
    CHECK(problems[3].what.find("found 4x4 pixels, expected 4x3") != std::string::npos);
    CHECK(problems[4].what.find("found pixels") != std::string::npos);
    CHECK(problems[5].missing);
}

TEST_CASE("farm: a process's lines, memory and end are known; it does not outlive its owner") {
    using std::chrono::milliseconds;
    ChildProcess::Options options;
    options.words = {"sh", "-c", "echo one; echo $COLOR; exit 3"};
    options.environment = {{"COLOR", "red"}};
    Result<ChildProcess> child = ChildProcess::start(options);
    REQUIRE(child.ok());
    CHECK(child->read_line(milliseconds(5000)) == "one");
    CHECK(child->read_line(milliseconds(5000)) == "red");
    CHECK_FALSE(child->read_line(milliseconds(5000)).has_value());
    CHECK(child->is_over());
    CHECK(child->wait().status == 3);
    options.words = {"sh", "-c", "kill -9 $$"};
    CHECK(ChildProcess::start(options)->wait().signal == 9);
    options.words = {"no-such-program"};
    CHECK(ChildProcess::start(options).error().message == "no-such-program: found no such program");
    int process = 0;
    {
        options.words = {"sh", "-c", "sleep 100 & echo $!; wait"};
        Result<ChildProcess> sleeping = ChildProcess::start(options);
        process = std::stoi(*sleeping->read_line(milliseconds(5000)));
        CHECK(::kill(process, 0) == 0);
    }
    const std::string state = fmt::format("/proc/{}/stat", process);
    for (int i = 0; i < 100 && std::filesystem::exists(state)
                    && read_text(state).find(") Z") == std::string::npos;
         ++i) {
        std::this_thread::sleep_for(milliseconds(20));
    }
    CHECK((!std::filesystem::exists(state) || read_text(state).find(") Z") != std::string::npos));
}

}  // namespace limn::farm_test
