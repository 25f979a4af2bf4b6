#include <locograph/common/error.h>
#include <locograph/world/perception/perception_thread.h>

#include <algorithm>

namespace locograph {

void PerceptionThreadOptions::validate() const {
  if (most_waiting < 1) throw Error("most_waiting is 0", "1 or more");
}

PerceptionThread::PerceptionThread(std::unique_ptr<Perception> perception,
                                   PerceptionThreadOptions options)
    : perception_(std::move(perception)), options_(std::move(options)) {
  options_.validate();
  newest_ = perception_->newest();
  thread_ = std::thread([this] { run(); });
}

PerceptionThread::~PerceptionThread() { stop(true); }

void PerceptionThread::configuration(double time_s, Eigen::VectorXd q) {
  {
    const std::lock_guard lock(mutex_);
    configurations_.emplace_back(time_s, std::move(q));
  }
  given_.notify_one();
}

void PerceptionThread::image(DepthImage image) {
  DepthImage dropped;  // freed after the lock
  {
    const std::lock_guard lock(mutex_);
    images_.push_back(std::move(image));
    if (images_.size() > options_.most_waiting) {
      dropped = std::move(images_.front());
      images_.pop_front();
      ++counts_.dropped;
    }
  }
  given_.notify_one();
}

std::shared_ptr<const WorldSnapshot> PerceptionThread::newest() const {
  const std::lock_guard lock(mutex_);
  return newest_;
}

PerceptionCounts PerceptionThread::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

std::unique_ptr<Perception> PerceptionThread::finish() {
  stop(false);
  return std::move(perception_);
}

void PerceptionThread::stop(bool at_once) {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    at_once_ = at_once_ || at_once;
  }
  given_.notify_one();
  if (thread_.joinable()) thread_.join();
}

/// The first image that need not wait. Under the lock, as has_work() and next_work().
std::size_t PerceptionThread::next_image() const {
  const auto ready = [this](const DepthImage& image) {
    return stopping_ || !(image.stamp_s > known_until_s_);
  };
  return static_cast<std::size_t>(std::ranges::find_if(images_, ready) - images_.begin());
}

bool PerceptionThread::has_work() const {
  return !configurations_.empty() || next_image() < images_.size();
}

PerceptionThread::Work PerceptionThread::next_work() {
  Work work;
  work.configurations.swap(configurations_);
  const std::size_t next = next_image();
  if (next == images_.size()) return work;
  work.image = std::move(images_[next]);
  images_.erase(images_.begin() + static_cast<std::ptrdiff_t>(next));
  return work;
}

void PerceptionThread::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    given_.wait(lock, [this] { return stopping_ || has_work(); });
    if (at_once_ || !has_work()) return;
    Work work = next_work();
    lock.unlock();
    do_work(std::move(work));
    lock.lock();
  }
}

/// An Error is what was refused.
template <class F>
void PerceptionThread::take_in(F&& f) {
  try {
    f();
  } catch (const Error& error) {
    const std::lock_guard lock(mutex_);
    ++counts_.refused;
    counts_.last_refusal = error.what();
  }
}

void PerceptionThread::do_work(Work work) {
  for (const auto& configuration : work.configurations) {
    take_in([&] {
      const auto& [time_s, q] = configuration;
      perception_->configuration(time_s, q);
      const std::lock_guard lock(mutex_);
      known_until_s_ = time_s;
    });
  }
  if (!work.image) return;
  take_in([&] {
    const std::shared_ptr<const WorldSnapshot> seen = perception_->image(std::move(*work.image));
    {
      const std::lock_guard lock(mutex_);
      newest_ = seen;
      counts_.images = perception_->images();
    }
    if (options_.on_snapshot) options_.on_snapshot(seen);
  });
}

}  // namespace locograph
