#include "tests/codec/memory_watch.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

std::atomic<std::size_t> held_now{0}, held_most{0};

void* take(std::size_t size) noexcept {
  void* p = std::malloc(size);
  if (p == nullptr) return nullptr;
  const std::size_t now = held_now += malloc_usable_size(p);
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

namespace ramcdb::codec::testing {

MemoryWatch::MemoryWatch() : held_(held_now) { held_most = held_; }

std::size_t MemoryWatch::peak() const { return held_most - held_; }

}  // namespace ramcdb::codec::testing
