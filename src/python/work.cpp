#include "python/work.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

namespace lumulus::python {
namespace {

namespace py = pybind11;

/// Ends work that was asked to stop; whoever asked throws what the caller sees.
struct Stopped {};

/// Work on another thread, as seen by the thread that waits for it.
class Running {
  public:
    Running(const py::object& progress, const std::function<void(const Hooks&)>& work)
        : progress_(progress), thread_([this, &work] { carryOut(work); }) {}

    /// Waits until the work has ended. Call with the GIL held.
    void wait() {
        constexpr std::chrono::milliseconds pause(50);
        for (bool ended = false; !ended;) {
            {
                const py::gil_scoped_release released;
                std::unique_lock lock(mutex_);
                ended = ended_.wait_for(lock, pause, [this] { return over_; });
            }
            if (!ended && !signal_ && PyErr_CheckSignals() != 0) {
                signal_.emplace();
                stop_ = true;
            }
        }
        {
            const py::gil_scoped_release released;
            thread_.join();
        }
        if (signal_) throw py::error_already_set(std::move(*signal_));
        if (thrown_) throw py::error_already_set(std::move(*thrown_));
        if (failure_) std::rethrow_exception(failure_);
    }

  private:
    void carryOut(const std::function<void(const Hooks&)>& work) {
        Hooks hooks;
        hooks.check = [this] {
            if (stop_) throw Stopped();
        };
        if (!progress_.is_none())
            hooks.report = [this](std::string_view step, std::uint64_t done, std::uint64_t total) {
                tell(step, done, total);
            };
        try {
            work(hooks);
        } catch (const Stopped&) {
        } catch (...) {
            failure_ = std::current_exception();
        }
        const std::lock_guard lock(mutex_);
        over_ = true;
        ended_.notify_all();
    }

    void tell(std::string_view step, std::uint64_t done, std::uint64_t total) {
        const py::gil_scoped_acquire held;
        try {
            progress_(py::str(step.data(), step.size()), done, total);
            return;
        } catch (py::error_already_set& error) {
            if (!thrown_) thrown_.emplace(std::move(error));
            stop_ = true;
        }
        throw Stopped();
    }

    const py::object& progress_;
    std::atomic<bool> stop_ = false;
    std::optional<py::error_already_set> signal_, thrown_;  ///< of Python; both with the GIL held
    std::exception_ptr failure_;
    std::mutex mutex_;
    std::condition_variable ended_;
    bool over_ = false;
    std::thread thread_;
};

}  // namespace

void run(const py::object& progress, const std::function<void(const Hooks&)>& work) {
    Running(progress, work).wait();
}

void warn(const std::string& text) {
    if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

}  // namespace lumulus::python
