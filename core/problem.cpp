#include <locograph/core/problem.h>

#include <algorithm>

namespace locograph {

std::int64_t BlockPattern::offset_of(int r, int c) const {
  const auto begin = row.begin() + column_begin[c];
  const auto end = row.begin() + column_begin[c + 1];
  return value_offset[std::lower_bound(begin, end, r) - row.begin()];
}

void Problem::begin(Graph& graph) {
  if (graph_ != &graph) place_.clear();
  graph_ = &graph;
  for (const int slot : touched_) {
    if (slot < static_cast<int>(place_.size())) place_[slot] = {};
  }
  touched_.clear();
  place_.resize(graph.vertex_slots());
  free_.clear();
  active_.resize(graph.vertex_pools().size());
  for (std::vector<ActiveVertex>& active : active_) active.clear();
  edges_.resize(graph.edge_pools().size());
  for (CompiledEdges& edges : edges_) edges.clear();
  state_size_ = 0;
  edge_count_ = 0;
  residual_count_ = 0;
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
  std::vector<int> all;
  all.reserve(graph.edge_count());
  for (int e = 0; e < graph.edge_slots(); ++e) {
    if (graph.edge_alive(e)) all.push_back(e);
  }
  compile_edges(all);
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
  std::vector<int> touching;
  for (const int slot : free_) {
    const std::vector<int>& incident = graph_->incident_edges(slot);
    touching.insert(touching.end(), incident.begin(), incident.end());
  }
  std::sort(touching.begin(), touching.end());
  touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
  if (held != nullptr) {
    std::erase_if(touching, [&](int e) {
      const std::span<const int> vertices = graph_->edge_vertices(e);
      return std::any_of(vertices.begin(), vertices.end(), [&](int v) {
        return place_[v].block < 0 && std::find(held->begin(), held->end(), v) == held->end();
      });
    });
  }
  for (const int e : touching) {
    for (const int v : graph_->edge_vertices(e)) {
      if (place_[v].state_offset < 0) add_vertex(v, -1);
    }
  }
  compile_edges(touching);
}

void Problem::compile_edges(const std::vector<int>& edge_slots) {
  for (const int e : edge_slots) {
    const Graph::EdgeRecord& record = graph_->edge_record(e);
    edges_[record.pool].edges.push_back(record.index);
    residual_count_ += graph_->edge_pools()[record.pool]->dimension(record.index);
  }
  edge_count_ = static_cast<int>(edge_slots.size());
  scratch_bytes_ = 0;
  for (std::size_t p = 0; p < edges_.size(); ++p) {
    CompiledEdges& compiled = edges_[p];
    const EdgePool& pool = *graph_->edge_pools()[p];
    std::sort(compiled.edges.begin(), compiled.edges.end());
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
        compiled.slots.push_back(slot);
      }
      compiled.slot_begin.push_back(static_cast<int>(compiled.slots.size()));
    }
    scratch_bytes_ = std::max(scratch_bytes_, pool.scratch_bytes(compiled));
  }
  build_pattern();
  build_offsets();
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
  for (std::size_t p = 0; p < edges_.size(); ++p) {
    CompiledEdges& compiled = edges_[p];
    const EdgePool& pool = *graph_->edge_pools()[p];
    for (const int index : compiled.edges) {
      const std::span<const int> vertices = pool.vertices(index);
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        const int bi = place_[vertices[i]].block;
        for (std::size_t j = i; j < vertices.size(); ++j) {
          const int bj = place_[vertices[j]].block;
          if (bi < 0 || bj < 0) {
            compiled.blocks.push_back(-1);
          } else {
            const bool transposed = bi > bj;
            const std::int64_t offset = pattern_.offset_of(std::min(bi, bj), std::max(bi, bj));
            compiled.blocks.push_back(2 * offset + (transposed ? 1 : 0));
          }
        }
      }
      compiled.block_begin.push_back(static_cast<std::int64_t>(compiled.blocks.size()));
    }
  }
}

}  // namespace locograph
