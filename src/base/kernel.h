// A function within the loops of an engine. It is part of each of its callers, so that
// what they give it as constants makes loops of their own.
//
// Not under the address sanitizer, whose checks would make the compiler work for minutes
// on copies of the same code.
#pragma once

#ifdef __SANITIZE_ADDRESS__
#define KERNEL static inline
#else
#define KERNEL static inline __attribute__((always_inline))
#endif
