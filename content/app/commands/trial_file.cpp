#include "content/app/commands/trial_file.h"

#include "content/game/wrinkle_trial_system.h"
#include "content/load/files/atomic_file.h"

#include <cstddef>
#include <cstdint>

namespace limn {

Result<std::vector<TrialRecord>> load_trials(const std::string& path) {
    constexpr std::uint64_t kMaxSize = 1 << 20;
    const std::vector<std::byte> bytes = LIMN_TRY(read_file(path, kMaxSize));
    return parse_trials({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path);
}

}  // namespace limn
