#include "allocations.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> held{0}, most{0};

void* countedIfAny(void* memory) {
    if (memory == nullptr) return nullptr;
    const std::size_t now = held += malloc_usable_size(memory);
    if (now > most) most = now;
    return memory;
}

void* counted(void* memory) {
    if (memory == nullptr) throw std::bad_alloc();
    return countedIfAny(memory);
}

void release(void* memory) {
    if (memory != nullptr) held -= malloc_usable_size(memory);
    std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) {
    return counted(std::malloc(std::max<std::size_t>(size, 1)));
}
// libFuzzer allocates so.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    return countedIfAny(std::malloc(std::max<std::size_t>(size, 1)));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
    const auto step = static_cast<std::size_t>(alignment);
    return counted(std::aligned_alloc(step, (size + step - 1) / step * step));
}
void operator delete(void* memory) noexcept {
    release(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    release(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
    release(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    release(memory);
}

namespace hgmm::fuzz {

PeakOfAllocations::PeakOfAllocations() : before_(held) {
    most = held.load();
}

std::size_t PeakOfAllocations::bytes() const {
    return most - before_;
}

}  // namespace hgmm::fuzz
