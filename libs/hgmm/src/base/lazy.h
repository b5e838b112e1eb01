#pragma once
#include <atomic>
#include <memory>
#include <mutex>

namespace hgmm {

/// A value that the first of possibly several readers makes.
template <typename T>
class Lazy {
 public:
    Lazy() = default;
    /// With a value of its own, if the other one has it; other readers may make it
    /// meanwhile.
    Lazy(const Lazy& o) {
        const T* const value = o.ready();
        if (value == nullptr) return;
        value_ = std::make_unique<T>(*value);
        ready_.store(value_.get(), std::memory_order_release);
    }
    Lazy& operator=(const Lazy&) = delete;
    /// @param make returns a std::unique_ptr<T>
    template <typename Make>
    const T& get(Make&& make) {
        if (const T* value = ready_.load(std::memory_order_acquire)) return *value;
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!value_) value_ = make();
        ready_.store(value_.get(), std::memory_order_release);
        return *value_;
    }
    /// What is there; null before get(). Not for concurrent use.
    T* value() { return value_.get(); }
    /// The same for readers.
    const T* ready() const { return ready_.load(std::memory_order_acquire); }
    void reset() {
        ready_.store(nullptr, std::memory_order_release);
        value_.reset();
    }

 private:
    std::unique_ptr<T> value_;
    std::atomic<const T*> ready_{nullptr};
    std::mutex mutex_;
};

}  // namespace hgmm
