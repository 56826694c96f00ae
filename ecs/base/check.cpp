#include "ecs/base/check.h"

#include <cstdio>
#include <cstdlib>

namespace limn {

void check_failed(const char* file, int line, const char* condition, const char* note) {
    std::fprintf(
        stderr, "%s:%d: check failed: %s%s%s\n", file, line, condition, note != nullptr ? ": " : "",
        note != nullptr ? note : "");
    std::abort();
}

}  // namespace limn
