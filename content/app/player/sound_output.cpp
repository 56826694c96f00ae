#include "content/app/player/sound_output.h"

#include "ecs/base/log.h"

#include <AL/al.h>
#include <AL/alc.h>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fcntl.h>
#include <optional>
#include <unistd.h>
#include <utility>

namespace limn {
namespace {

constexpr double kLargestLag = 0.08;   // [s]; beyond it the sound jumps
constexpr double kTolerance = 0.005;   // [s]
constexpr double kPartPerFrame = 0.1;  // of the lag, made up for in one frame

/// The default device. Its libraries complain on stderr where there is none, which is no error
/// here.
ALCdevice* open_device() {
    const int errors = dup(STDERR_FILENO);
    const int nowhere = open("/dev/null", O_WRONLY);
    if (errors >= 0 && nowhere >= 0) {
        dup2(nowhere, STDERR_FILENO);
    }
    ALCdevice* const device = alcOpenDevice(nullptr);
    if (errors >= 0) {
        dup2(errors, STDERR_FILENO);
        close(errors);
    }
    if (nowhere >= 0) {
        close(nowhere);
    }
    return device;
}

}  // namespace

std::optional<double> sound_correction(double scene, double sound) {
    const double lag = sound - scene;
    if (std::abs(lag) > kLargestLag) {
        return std::nullopt;
    }
    return std::abs(lag) > kTolerance ? kPartPerFrame * lag : 0.0;
}

struct SoundOutput::Device {
    ALCdevice* device = nullptr;
    ALCcontext* context = nullptr;
    std::vector<ALuint> buffers;
    std::vector<ALuint> sources;

    Device() = default;
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;
    ~Device() {
        clear();
        alcMakeContextCurrent(nullptr);
        alcDestroyContext(context);
        alcCloseDevice(device);
    }

    void clear() {
        alDeleteSources(static_cast<ALsizei>(sources.size()), sources.data());
        alDeleteBuffers(static_cast<ALsizei>(buffers.size()), buffers.data());
        sources.clear();
        buffers.clear();
    }

    void add(const SceneSound& sound) {
        std::vector<std::int16_t> samples(sound.data.samples.size());
        std::ranges::transform(sound.data.samples, samples.begin(), [&](float sample) {
            return static_cast<std::int16_t>(
                std::lround(32767 * std::clamp(sound.gain * sample, -1.0f, 1.0f)));
        });
        ALuint buffer = 0;
        alGenBuffers(1, &buffer);
        alBufferData(
            buffer, sound.data.channels == 1 ? AL_FORMAT_MONO16 : AL_FORMAT_STEREO16,
            samples.data(), static_cast<ALsizei>(2 * samples.size()), sound.data.rate);
        ALuint source = 0;
        alGenSources(1, &source);
        alSourcei(source, AL_SOURCE_RELATIVE, AL_TRUE);
        alSourcei(source, AL_BUFFER, static_cast<ALint>(buffer));
        buffers.push_back(buffer);
        sources.push_back(source);
    }
};

SoundOutput::SoundOutput() = default;
SoundOutput::~SoundOutput() = default;

void SoundOutput::set_sounds(std::vector<SceneSound> sounds) {
    sounds_ = std::move(sounds);
    if (!sounds_.empty() && !tried_) {
        tried_ = true;
        if (ALCdevice* const device = open_device()) {
            device_ = std::make_unique<Device>();
            device_->device = device;
            device_->context = alcCreateContext(device, nullptr);
            alcMakeContextCurrent(device_->context);
        } else {
            log_info("no sound device is found: sounds are not heard");
        }
    }
    if (device_ != nullptr) {
        device_->clear();
        for (const SceneSound& sound : sounds_) {
            device_->add(sound);
        }
    }
}

double SoundOutput::update(double time, bool running) {
    double correction = 0;
    is_heard_ = false;
    for (std::size_t i = 0; device_ != nullptr && i < sounds_.size(); ++i) {
        const ALuint source = device_->sources[i];
        const std::optional<double> wanted =
            running ? sound_position(sounds_[i], time) : std::nullopt;
        ALint state = AL_STOPPED;
        alGetSourcei(source, AL_SOURCE_STATE, &state);
        if (!wanted) {
            if (state == AL_PLAYING) {
                alSourceStop(source);
            }
            continue;
        }
        is_heard_ = true;
        if (state != AL_PLAYING && sounds_[i].data.duration() - *wanted < kLargestLag) {
            continue;  // it has ended, a little before the scene
        }
        ALfloat offset = 0;
        alGetSourcef(source, AL_SEC_OFFSET, &offset);
        const std::optional<double> found =
            state == AL_PLAYING ? sound_correction(*wanted, static_cast<double>(offset))
                                : std::nullopt;
        if (found) {
            correction = correction == 0 ? *found : correction;
        } else {
            alSourcef(source, AL_SEC_OFFSET, static_cast<ALfloat>(*wanted));
            if (state != AL_PLAYING) {
                alSourcePlay(source);
            }
        }
    }
    return correction;
}

}  // namespace limn
