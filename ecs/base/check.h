#pragma once

namespace limn {

/// Prints "file:line: check failed: condition" (and `note`, if any) to stderr and aborts.
[[noreturn]] void
check_failed(const char* file, int line, const char* condition, const char* note = nullptr);

}  // namespace limn

// Stops at a programming error with file and line, in all builds except LIMN_SHIPPED. For
// preconditions on function entry, not per array element. Errors from outside (files, GPUs,
// users) are a Result instead.
#if defined(LIMN_SHIPPED)
#define LIMN_CHECK(condition) static_cast<void>(sizeof(!(condition)))
#define LIMN_CHECK_NOTE(condition, note) static_cast<void>(sizeof(!(condition)))
#else
#define LIMN_CHECK(condition)                                                                      \
    ((condition) ? static_cast<void>(0) : ::limn::check_failed(__FILE__, __LINE__, #condition))
#define LIMN_CHECK_NOTE(condition, note)                                                           \
    ((condition) ? static_cast<void>(0)                                                            \
                 : ::limn::check_failed(__FILE__, __LINE__, #condition, note))
#endif
