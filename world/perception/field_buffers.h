#pragma once
/// Buffers for fields that are handed out as shared pointers and come back by themselves when
/// nobody holds them any more. Internal: LocalMap's.
///
///     LocalField& next = buffers.free_one();       // nobody reads it
///     fill(next);
///     std::shared_ptr<const LocalField> field = buffers.share(next);
///
/// Neither side waits for the other. A shared pointer's own memory lies beside its buffer, so
/// nothing is allocated as long as a buffer is free. All members are for one thread; readers may
/// let go of what they hold in any other, also after the buffers' owner is gone.

#include <locograph/world/perception/local_field.h>

#include <memory>

namespace locograph {

class FieldBuffers {
 public:
  /// count: how many there are at first, 1 or more; each begins as a copy of blank.
  FieldBuffers(const LocalField& blank, int count);

  /// Another one is made when all are held.
  LocalField& free_one();
  /// field: the last free_one().
  std::shared_ptr<const LocalField> share(const LocalField& field);
  int count() const;

 private:
  struct Buffer;
  struct Pool;
  template <class T>
  struct BesideBuffer;

  std::shared_ptr<Pool> pool_;
};

}  // namespace locograph
