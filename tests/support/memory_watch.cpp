#include "tests/support/memory_watch.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> held_now{0}, held_most{0}, taken_ever{0};

void* take(std::size_t size) noexcept {
  void* p = std::malloc(size);
  if (p == nullptr) return nullptr;
  const std::size_t size_taken = malloc_usable_size(p);
  const std::size_t now = held_now += size_taken;
  taken_ever += size_taken;
  if (now > held_most) held_most = now;
  return p;
}

void* take_or_throw(std::size_t size) {
  void* p = take(size);
  if (p == nullptr) throw std::bad_alloc();
  return p;
}

void give_back(void* p) noexcept {
  if (p != nullptr) held_now -= malloc_usable_size(p);
  std::free(p);
}

}  // namespace

void* operator new(std::size_t size) { return take_or_throw(size); }
void* operator new[](std::size_t size) { return take_or_throw(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return take(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return take(size); }
void operator delete(void* p) noexcept { give_back(p); }
void operator delete[](void* p) noexcept { give_back(p); }
void operator delete(void* p, std::size_t) noexcept { give_back(p); }
void operator delete[](void* p, std::size_t) noexcept { give_back(p); }
void operator delete(void* p, const std::nothrow_t&) noexcept { give_back(p); }
void operator delete[](void* p, const std::nothrow_t&) noexcept { give_back(p); }

namespace ramcdb::test {

MemoryWatch::MemoryWatch() : held_(held_now), taken_(taken_ever) { held_most = held_; }

std::size_t MemoryWatch::peak() const { return held_most - held_; }

std::size_t MemoryWatch::taken() const { return taken_ever - taken_; }

}  // namespace ramcdb::test
