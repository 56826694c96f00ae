#include "content/load/files/atomic_file.h"

#include "ecs/base/check.h"
#include "ecs/base/text.h"
#include "ecs/base/type_name.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <mutex>
#include <sys/stat.h>
#include <unistd.h>

namespace limn {

namespace {

/// An open file, closed at the end of its scope.
class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (fd_ >= 0) {
            ::close(fd_);
        }
    }
    [[nodiscard]] int get() const { return fd_; }
    [[nodiscard]] bool is_open() const { return fd_ >= 0; }

  private:
    int fd_;
};

Error system_error(const std::string& path, const char* what) {
    return fail("{}: {}: {}", path, what, std::strerror(errno));
}

/// Writes and flushes; false with errno on failure.
bool write_all(int fd, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written =
            ::write(fd, bytes.data(), std::min<std::size_t>(bytes.size(), 1 << 30));
        if (written < 0) {
            if (errno == EINTR) {
                continue;
            }
            return false;
        }
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    // Without the flush a system crash could leave an empty file under the new name. Pipes and some
    // network file systems cannot be flushed; that is not an error.
    return ::fsync(fd) == 0 || errno == EINVAL || errno == EROFS;
}

std::filesystem::path folder_of(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    return folder.empty() ? std::filesystem::path(".") : folder;
}

/// The hidden file in the same folder that replaces `path` in one step.
std::string partial_name(const std::string& path) {
    const std::string name = std::filesystem::path(path).filename().string();
    return (folder_of(path) / ("." + name + "." + std::to_string(::getpid()) + ".partial"))
        .string();
}

/// Links the unnamed file to `path`, through the partial name if that exists. False with errno.
bool link_to_name(int fd, const std::string& path) {
    const std::string self = "/proc/self/fd/" + std::to_string(fd);
    if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, path.c_str(), AT_SYMLINK_FOLLOW) == 0) {
        return true;
    }
    if (errno != EEXIST) {
        return false;
    }
    const std::string partial = partial_name(path);
    ::unlink(partial.c_str());
    if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, partial.c_str(), AT_SYMLINK_FOLLOW) != 0) {
        return false;
    }
    if (::rename(partial.c_str(), path.c_str()) != 0) {
        const int reason = errno;
        ::unlink(partial.c_str());
        errno = reason;
        return false;
    }
    return true;
}

Status write_through_partial(const std::string& path, std::span<const std::byte> bytes) {
    const std::string partial = partial_name(path);
    const Descriptor file(::open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666));
    if (!file.is_open()) {
        return system_error(path, "cannot be created");
    }
    if (!write_all(file.get(), bytes) || ::rename(partial.c_str(), path.c_str()) != 0) {
        Error error = system_error(path, "cannot be written");
        ::unlink(partial.c_str());
        return error;
    }
    return Done{};
}

/// Of the ReadRecorder that exists.
struct RecordedReads {
    std::mutex mutex;
    bool active = false;
    std::vector<std::string> paths;
};

RecordedReads& recorded_reads() {
    static RecordedReads reads;
    return reads;
}

void record_read(const std::string& path) {
    RecordedReads& reads = recorded_reads();
    const std::scoped_lock lock(reads.mutex);
    if (reads.active) {
        reads.paths.push_back(path);
    }
}

}  // namespace

ReadRecorder::ReadRecorder() {
    RecordedReads& reads = recorded_reads();
    const std::scoped_lock lock(reads.mutex);
    LIMN_CHECK(!reads.active);
    reads.active = true;
    reads.paths.clear();
}

ReadRecorder::~ReadRecorder() {
    RecordedReads& reads = recorded_reads();
    const std::scoped_lock lock(reads.mutex);
    reads.active = false;
}

std::vector<std::string> ReadRecorder::paths() const {
    RecordedReads& reads = recorded_reads();
    const std::scoped_lock lock(reads.mutex);
    return reads.paths;
}

Status write_file(const std::string& path, std::span<const std::byte> bytes) {
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        return fail("{}: found a folder, expected the name of a file", path);
    }
    if (!std::filesystem::is_directory(folder_of(path), ignored)) {
        return fail("{}: the folder {} does not exist", path, folder_of(path).string());
    }
    const Descriptor file(::open(folder_of(path).c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666));
    if (!file.is_open()) {
        return write_through_partial(path, bytes);
    }
    if (!write_all(file.get(), bytes)) {
        return system_error(path, "cannot be written");
    }
    if (!link_to_name(file.get(), path)) {
        return write_through_partial(path, bytes);  // no /proc, or hard links are not permitted
    }
    return Done{};
}

Status write_file(const std::string& path, const std::string& text) {
    return write_file(path, std::as_bytes(std::span(text)));
}

std::string file_suggestion(const std::string& path) {
    std::vector<std::string> names;
    std::error_code error;
    for (std::filesystem::directory_iterator entry(folder_of(path), error), end;
         !error && entry != end; entry.increment(error)) {
        names.push_back(entry->path().filename().string());
    }
    const std::string nearest =
        nearest_name(std::filesystem::path(path).filename().string(), names);
    return nearest.empty() ? "" : format_text(" (did you mean {}?)", nearest);
}

Result<std::vector<std::byte>> read_file(const std::string& path, std::uint64_t max_size) {
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
    if (!file.is_open()) {
        if (errno == ENOENT) {
            return fail("{}: no such file{}", path, file_suggestion(path));
        }
        return system_error(path, "cannot be read");
    }
    struct stat status {};
    if (::fstat(file.get(), &status) != 0) {
        return system_error(path, "cannot be read");
    }
    if (!S_ISREG(status.st_mode)) {
        return fail(
            "{}: found a {}, expected a file", path, S_ISDIR(status.st_mode) ? "folder" : "device");
    }
    const auto size = static_cast<std::uint64_t>(status.st_size);
    if (size > max_size) {
        return fail("{}: found {} bytes, expected at most {}", path, size, max_size);
    }
    std::vector<std::byte> bytes(size);
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t got = ::read(file.get(), bytes.data() + done, bytes.size() - done);
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got < 0) {
            return system_error(path, "cannot be read");
        }
        if (got == 0) {
            return fail("{}: the file ended after {} of {} bytes", path, done, bytes.size());
        }
        done += static_cast<std::size_t>(got);
    }
    record_read(path);
    return bytes;
}

}  // namespace limn
