// Every new and delete of the program and of its libraries, in the program's hands.
#pragma once
#include <cstddef>

/// Defined by the program. Null where memory ends.
void* allocate(std::size_t size) noexcept;
void release(void* memory) noexcept;
