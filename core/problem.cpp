#include <locograph/core/linear_solver.h>
#include <locograph/core/problem.h>

#include <algorithm>
#include <array>

namespace locograph {

namespace {

/// Chunks of a problem worth sharing: enough for the threads of one processor to stay busy.
constexpr int kChunks = 8;
/// Below this much estimated work a pass is over before a second thread has woken up.
constexpr double kLeastWork = 100e-6;  // s

/// Seconds that linearising an edge takes, roughly: it only has to balance chunks.
double edge_work(double rows, double columns) {
  return 1e-9 * (40.0 + rows * columns * (1.5 + 0.15 * columns));
}

}  // namespace

void Problem::Destinations::start(std::int64_t places, std::int64_t size) {
  last_.assign(static_cast<std::size_t>(places), {});
  reductions_.clear();
  size_ = size;
}

std::int64_t Problem::Destinations::of(std::int64_t place, std::int64_t own, int size, int chunk) {
  Last& last = last_[place];
  if (last.chunk < 0) last = {chunk, own};
  if (last.chunk != chunk) {
    reductions_.push_back({size_, own, size});
    last = {chunk, size_};
    size_ += size;
  }
  return last.offset;
}

void Problem::Destinations::finish(Reductions& out) {
  // Those of one destination in the order of the chunks, in which they were made.
  std::sort(reductions_.begin(), reductions_.end(), [](const auto& a, const auto& b) {
    return a.to != b.to ? a.to < b.to : a.from < b.from;
  });
  out.size = size_;
  out.part_begin.assign(1, 0);
  const int count = static_cast<int>(reductions_.size());
  for (int part = 1; part <= kChunks && out.part_begin.back() < count; ++part) {
    int end = std::max(out.part_begin.back() + 1, count * part / kChunks);
    while (end < count && reductions_[end].to == reductions_[end - 1].to) ++end;
    out.part_begin.push_back(end);
  }
  out.all.swap(reductions_);
}

int BlockPattern::block_of(int r, int c) const {
  const auto begin = row.begin() + column_begin[c];
  const auto end = row.begin() + column_begin[c + 1];
  return static_cast<int>(std::lower_bound(begin, end, r) - row.begin());
}

void Problem::begin(Graph& graph) {
  if (graph_ != &graph) place_.clear();
  graph_ = &graph;
  for (const int slot : touched_) {
    if (slot < static_cast<int>(place_.size())) place_[slot] = {};
  }
  touched_.clear();
  compiled_slots_.clear();
  place_.resize(graph.vertex_slots());
  free_.clear();
  active_.resize(graph.vertex_pools().size());
  for (std::vector<ActiveVertex>& active : active_) active.clear();
  edges_.resize(graph.edge_pools().size());
  for (CompiledEdges& edges : edges_) edges.clear();
  state_size_ = 0;
  edge_count_ = 0;
  residual_count_ = 0;
  constraints_.clear();
  constraint_rows_ = 0;
  pattern_.dimension.clear();
  pattern_.scalar_begin.assign(1, 0);
}

void Problem::add_vertex(int slot, int block) {
  const Graph::VertexRecord& record = graph_->vertex_record(slot);
  Place& place = place_[slot];
  touched_.push_back(slot);
  place.block = block;
  place.state_offset = state_size_;
  place.derived_index = static_cast<int>(active_[record.pool].size());
  ActiveVertex active;
  active.index = record.index;
  active.state_offset = state_size_;
  if (block >= 0) {
    const int dimension = graph_->dimension(slot);
    active.tangent_offset = pattern_.scalar_begin.back();
    pattern_.dimension.push_back(dimension);
    pattern_.scalar_begin.push_back(active.tangent_offset + dimension);
    free_.push_back(slot);
  }
  active_[record.pool].push_back(active);
  state_size_ += graph_->state_size(slot);
}

void Problem::compile(Graph& graph) {
  begin(graph);
  for (const bool eliminated : {false, true}) {
    for (int slot = 0; slot < graph.vertex_slots(); ++slot) {
      if (!graph.vertex_alive(slot)) continue;
      const Graph::VertexRecord& vertex = graph.vertex_record(slot);
      if (vertex.eliminate != eliminated) continue;
      add_vertex(slot, vertex.fixed ? -1 : static_cast<int>(free_.size()));
    }
    if (!eliminated) pattern_.kept = static_cast<int>(free_.size());
  }
  compiled_slots_.reserve(graph.edge_count());
  for (int e = 0; e < graph.edge_slots(); ++e) {
    if (graph.edge_alive(e)) compiled_slots_.push_back(e);
  }
  compile_edges();
}

void Problem::compile(Graph& graph, std::span<const int> free_vertex_slots) {
  begin(graph);
  compile_window(free_vertex_slots, nullptr);
}

void Problem::compile(Graph& graph, std::span<const int> free_vertex_slots,
                      std::span<const int> held) {
  begin(graph);
  compile_window(free_vertex_slots, &held);
}

void Problem::compile_on(Graph& graph, std::span<const int> edge_slots) {
  begin(graph);
  for (const bool eliminated : {false, true}) {
    for (const int e : edge_slots) {
      for (const int v : graph.edge_vertices(e)) {
        const Graph::VertexRecord& vertex = graph.vertex_record(v);
        if (vertex.eliminate != eliminated || place_[v].state_offset >= 0) continue;
        add_vertex(v, vertex.fixed ? -1 : static_cast<int>(free_.size()));
      }
    }
    if (!eliminated) pattern_.kept = static_cast<int>(free_.size());
  }
  compiled_slots_.assign(edge_slots.begin(), edge_slots.end());
  compile_edges();
}

void Problem::compile_window(std::span<const int> free_vertex_slots,
                             const std::span<const int>* held) {
  for (const bool eliminated : {false, true}) {
    for (const int slot : free_vertex_slots) {
      const Graph::VertexRecord& vertex = graph_->vertex_record(slot);
      if (vertex.eliminate != eliminated || vertex.fixed || place_[slot].state_offset >= 0)
        continue;
      add_vertex(slot, static_cast<int>(free_.size()));
    }
    if (!eliminated) pattern_.kept = static_cast<int>(free_.size());
  }
  std::vector<int>& touching = compiled_slots_;
  const auto touch = [&](int slot) {
    const std::vector<int>& incident = graph_->incident_edges(slot);
    touching.insert(touching.end(), incident.begin(), incident.end());
  };
  for (const int slot : free_) touch(slot);
  if (held != nullptr) {
    for (const int slot : free_vertex_slots) {
      if (!graph_->vertex_record(slot).fixed || place_[slot].state_offset >= 0) continue;
      add_vertex(slot, -1);
      touch(slot);
    }
  }
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  if (held != nullptr) {
    std::erase_if(touching, [&](int e) {
      const std::span<const int> vertices = graph_->edge_vertices(e);
      return std::any_of(vertices.begin(), vertices.end(), [&](int v) {
        return place_[v].state_offset < 0 &&
               std::find(held->begin(), held->end(), v) == held->end();
      });
    });
  }
  for (const int e : touching) {
    for (const int v : graph_->edge_vertices(e)) {
      if (place_[v].state_offset < 0) add_vertex(v, -1);
    }
  }
  compile_edges();
}

void Problem::analyse(LinearSolver& solver) const {
  try {
    solver.analyse(pattern_);
  } catch (const TiedRowsError& tied) {
    const auto id = [&](int row) { return std::to_string(graph_->vertex_record(free_[row]).id); };
    throw Error("vertices " + id(tied.first) + " and " + id(tied.second) + TiedRowsError::kWhy,
                TiedRowsError::kExpected);
  }
}

void Problem::compile_edges() {
  for (const int e : compiled_slots_) {
    const Graph::EdgeRecord& record = graph_->edge_record(e);
    edges_[record.pool].edges.push_back(record.index);
    const int dimension = graph_->edge_pools()[record.pool]->dimension(record.index);
    residual_count_ += dimension;
    if (record.constraint != ConstraintKind::kNone) {
      constraints_.push_back(
          {e, record.pool, record.index, constraint_rows_, dimension, record.constraint});
      constraint_rows_ += dimension;
    }
  }
  edge_count_ = static_cast<int>(compiled_slots_.size());
  for (CompiledEdges& compiled : edges_) std::sort(compiled.edges.begin(), compiled.edges.end());
  divide_into_chunks();
  scratch_bytes_ = 0;
  for (std::size_t p = 0; p < edges_.size(); ++p) {
    CompiledEdges& compiled = edges_[p];
    const EdgePool& pool = *graph_->edge_pools()[p];
    for (const int index : compiled.edges) {
      for (const int v : pool.vertices(index)) {
        const Graph::VertexRecord& vertex = graph_->vertex_record(v);
        const Place& place = place_[v];
        CompiledEdges::Slot slot;
        slot.pool = graph_->vertex_pools()[vertex.pool].get();
        slot.vertex_index = vertex.index;
        slot.pool_number = vertex.pool;
        slot.derived_index = place.derived_index;
        slot.state_offset = place.state_offset;
        slot.tangent_offset = place.block < 0 ? -1 : pattern_.scalar_begin[place.block];
        slot.gradient_offset = slot.tangent_offset;
        compiled.slots.push_back(slot);
      }
      compiled.slot_begin.push_back(static_cast<int>(compiled.slots.size()));
    }
    scratch_bytes_ = std::max(scratch_bytes_, pool.scratch_bytes(compiled));
  }
  compile_constraints();
  build_pattern();
  build_offsets();
}

void Problem::divide_into_chunks() {
  // Edges by the last of their free vertices; those without one come first.
  work_.assign(free_.size() + 1, 0.0);
  const auto last_block = [&](const EdgePool& pool, int index) {
    int last = -1;
    for (const int v : pool.vertices(index)) last = std::max(last, place_[v].block);
    return last;
  };
  double total = 0.0;
  for (std::size_t p = 0; p < edges_.size(); ++p) {
    const EdgePool& pool = *graph_->edge_pools()[p];
    for (const int index : edges_[p].edges) {
      double columns = 0.0;
      int last = -1;
      for (const int v : pool.vertices(index)) {
        const int block = place_[v].block;
        if (block >= 0) columns += pattern_.dimension[block];
        last = std::max(last, block);
      }
      const double work = edge_work(pool.dimension(index), columns);
      work_[last + 1] += work;
      total += work;
    }
  }
  chunks_ = total < kLeastWork ? 1 : kChunks;
  for (CompiledEdges& compiled : edges_) {
    compiled.chunk_begin.assign(chunks_ + 1, static_cast<int>(compiled.edges.size()));
    compiled.chunk_begin[0] = 0;
  }
  if (chunks_ == 1) return;
  chunk_of_.resize(work_.size());
  double sum = 0.0;
  for (std::size_t b = 0; b < work_.size(); ++b) {
    chunk_of_[b] =
        std::min(chunks_ - 1, static_cast<int>(chunks_ * (sum + 0.5 * work_[b]) / total));
    sum += work_[b];
  }
  for (std::size_t p = 0; p < edges_.size(); ++p) {
    CompiledEdges& compiled = edges_[p];
    const EdgePool& pool = *graph_->edge_pools()[p];
    std::vector<int>& begin = compiled.chunk_begin;
    begin.assign(chunks_ + 1, 0);
    for (const int index : compiled.edges) ++begin[chunk_of_[last_block(pool, index) + 1] + 1];
    for (int c = 0; c < chunks_; ++c) begin[c + 1] += begin[c];
    sorted_.resize(compiled.edges.size());
    std::array<int, kChunks> next;
    std::copy(begin.begin(), begin.end() - 1, next.begin());
    for (const int index : compiled.edges) {
      sorted_[next[chunk_of_[last_block(pool, index) + 1]]++] = index;
    }
    std::copy(sorted_.begin(), sorted_.end(), compiled.edges.begin());
  }
}

/// So far k is the edge's index in its pool; within a chunk edges are sorted by it.
void Problem::compile_constraints() {
  for (CompiledConstraint& c : constraints_) {
    CompiledEdges& compiled = edges_[c.pool];
    const auto edges = compiled.edges.begin();
    for (int chunk = 0; chunk < chunks_; ++chunk) {
      const auto end = edges + compiled.chunk_begin[chunk + 1];
      const auto found = std::lower_bound(edges + compiled.chunk_begin[chunk], end, c.k);
      if (found == end || *found != c.k) continue;
      c.k = static_cast<int>(found - edges);
      break;
    }
    compiled.constraint_row.resize(compiled.edges.size(), -1);
    compiled.constraint_row[c.k] = c.row;
    compiled.one_sided.resize(compiled.edges.size(), 0);
    compiled.one_sided[c.k] = c.kind == ConstraintKind::kInequality ? 1 : 0;
  }
}

void Problem::build_pattern() {
  pairs_.clear();
  const std::uint64_t n = free_.size();
  for (std::uint64_t b = 0; b < n; ++b) pairs_.push_back(b << 32 | b);
  for (std::size_t p = 0; p < edges_.size(); ++p) {
    const EdgePool& pool = *graph_->edge_pools()[p];
    for (const int index : edges_[p].edges) {
      const std::span<const int> vertices = pool.vertices(index);
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        const int bi = place_[vertices[i]].block;
        if (bi < 0) continue;
        for (std::size_t j = i + 1; j < vertices.size(); ++j) {
          const int bj = place_[vertices[j]].block;
          if (bj < 0) continue;
          const std::uint64_t column = std::max(bi, bj), row = std::min(bi, bj);
          pairs_.push_back(column << 32 | row);
        }
      }
    }
  }
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  pattern_.column_begin.assign(n + 1, 0);
  pattern_.row.clear();
  pattern_.value_offset.assign(1, 0);
  for (const std::uint64_t pair : pairs_) {
    const int column = static_cast<int>(pair >> 32), row = static_cast<int>(pair & 0xffffffffu);
    pattern_.row.push_back(row);
    pattern_.value_offset.push_back(pattern_.value_offset.back() +
                                    std::int64_t{pattern_.dimension[row]} *
                                        pattern_.dimension[column]);
    ++pattern_.column_begin[column + 1];
  }
  for (std::uint64_t c = 0; c < n; ++c) pattern_.column_begin[c + 1] += pattern_.column_begin[c];
}

void Problem::build_offsets() {
  Destinations &hessian = hessian_destinations_, &gradient = gradient_destinations_;
  hessian.start(pattern_.blocks(), pattern_.values());
  gradient.start(pattern_.size(), pattern_.scalar_size());
  for (CompiledEdges& compiled : edges_) {
    compiled.blocks.clear();
    compiled.block_begin.assign(1, 0);
  }
  for (int chunk = 0; chunk < chunks_; ++chunk) {
    for (std::size_t p = 0; p < edges_.size(); ++p) {
      CompiledEdges& compiled = edges_[p];
      const EdgePool& pool = *graph_->edge_pools()[p];
      for (int k = compiled.chunk_begin[chunk]; k < compiled.chunk_begin[chunk + 1]; ++k) {
        const std::span<const int> vertices = pool.vertices(compiled.edges[k]);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
          const int bi = place_[vertices[i]].block;
          if (bi >= 0) {
            CompiledEdges::Slot& slot = compiled.slots[compiled.slot_begin[k] + i];
            slot.gradient_offset = static_cast<int>(
                gradient.of(bi, slot.tangent_offset, pattern_.dimension[bi], chunk));
          }
          for (std::size_t j = i; j < vertices.size(); ++j) {
            const int bj = place_[vertices[j]].block;
            if (bi < 0 || bj < 0) {
              compiled.blocks.push_back(-1);
              continue;
            }
            const int row = std::min(bi, bj), column = std::max(bi, bj);
            const int block = pattern_.block_of(row, column);
            const std::int64_t offset =
                hessian.of(block, pattern_.value_offset[block],
                           pattern_.dimension[row] * pattern_.dimension[column], chunk);
            compiled.blocks.push_back(2 * offset + (bi > bj ? 1 : 0));
          }
        }
        compiled.block_begin.push_back(static_cast<std::int64_t>(compiled.blocks.size()));
      }
    }
  }
  hessian.finish(hessian_reductions_);
  gradient.finish(gradient_reductions_);
}

}  // namespace locograph
