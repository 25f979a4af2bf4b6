#pragma once
/// Perception in a thread of its own, so that whoever gives it images and whoever plans wait for
/// nothing.
///
///     PerceptionThreadOptions options;
///     options.on_snapshot = [&](auto seen) { planner.show(seen); };
///     PerceptionThread thread(std::move(perception), options);
///     thread.configuration(0.0, q);       // from the drives, as they come
///     thread.image(camera_image(0.0));    // from the cameras, as they come
///     use(thread.newest());               // at any time
///     perception = thread.finish();       // all that was given has been taken in
///
/// An image waits until the configuration of its stamp is known, which may come later. Of more than
/// most_waiting images the oldest is dropped: a planner needs what is there now. Images that
/// Perception refuses change nothing; they are counted, and the last reason is kept. The same of
/// configurations.
///
/// All members but finish() may be called from any thread. What becomes of an image depends on how
/// fast the thread is; who needs the same bits again calls Perception itself, by simulated time.

#include <locograph/world/perception/perception.h>

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace locograph {

struct PerceptionThreadOptions {
  std::size_t most_waiting = 8;
  /// Called in the thread after each image, as LocalPlanner::show(); may be empty. It throws
  /// nothing.
  std::function<void(std::shared_ptr<const WorldSnapshot>)> on_snapshot = {};

  void validate() const;
};

struct PerceptionCounts {
  int images = 0;   ///< taken in
  int dropped = 0;  ///< too many were waiting
  int refused = 0;  ///< images and configurations
  std::string last_refusal;
};

class PerceptionThread {
 public:
  /// perception: not null.
  explicit PerceptionThread(std::unique_ptr<Perception> perception,
                            PerceptionThreadOptions options = {});
  /// What still waits is left.
  ~PerceptionThread();
  PerceptionThread(const PerceptionThread&) = delete;
  PerceptionThread& operator=(const PerceptionThread&) = delete;

  void configuration(double time_s, Eigen::VectorXd q);
  void image(DepthImage image);
  std::shared_ptr<const WorldSnapshot> newest() const;
  PerceptionCounts counts() const;

  /// Ends the thread once all that was given has been taken in; images whose configuration has not
  /// come are refused. Nothing may be given after it.
  std::unique_ptr<Perception> finish();

 private:
  /// What the thread has to do next, taken out of the queues.
  struct Work {
    std::deque<std::pair<double, Eigen::VectorXd>> configurations;
    std::optional<DepthImage> image;
  };

  void run();
  std::size_t next_image() const;
  bool has_work() const;
  Work next_work();
  void do_work(Work work);
  template <class F>
  void take_in(F&& f);
  void stop(bool at_once);

  std::unique_ptr<Perception> perception_;  // of the thread, while it runs
  const PerceptionThreadOptions options_;
  mutable std::mutex mutex_;  // of all that follows
  std::condition_variable given_;
  std::deque<std::pair<double, Eigen::VectorXd>> configurations_;
  std::deque<DepthImage> images_;
  double known_until_s_ = -std::numeric_limits<double>::infinity();  // configurations taken in
  bool stopping_ = false, at_once_ = false;
  std::shared_ptr<const WorldSnapshot> newest_;
  PerceptionCounts counts_;
  std::thread thread_;  // the last member: it uses the others
};

}  // namespace locograph
