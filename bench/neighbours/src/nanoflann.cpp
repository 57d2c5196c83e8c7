// nanoflann behind three functions: a tree, the nearest k within a radius, all within a radius.

#include <cstddef>
#include <cstdint>
#include <nanoflann.hpp>
#include <utility>
#include <vector>

namespace {

struct Cloud {
    const float* xyz;
    size_t n;
    size_t kdtree_get_point_count() const { return n; }
    float kdtree_get_pt(size_t i, size_t axis) const { return xyz[3 * i + axis]; }
    template <class Box> bool kdtree_get_bbox(Box&) const { return false; }
};

using Tree = nanoflann::KDTreeSingleIndexAdaptor<
    nanoflann::L2_Simple_Adaptor<float, Cloud>, Cloud, 3, uint32_t>;

struct Index {
    Cloud cloud;
    Tree tree;
    std::vector<uint32_t> indices;
    std::vector<float> distances;
    std::vector<std::pair<uint32_t, float>> found;
    Index(const float* xyz, size_t n, size_t leaf)
        : cloud{xyz, n}, tree(3, cloud, nanoflann::KDTreeSingleIndexAdaptorParams(leaf)) {}
};

}  // namespace

extern "C" {

void* flann_build(const float* xyz, size_t n, size_t leaf) {
    auto* index = new Index(xyz, n, leaf);
    index->tree.buildIndex();
    return index;
}

void flann_free(void* index) { delete static_cast<Index*>(index); }

size_t flann_memory(void* index) {
    auto* it = static_cast<Index*>(index);
    return it->tree.usedMemory(it->tree);
}

// Number of points found, and the sum of their squared distances.
size_t flann_nearest(void* index, const float* p, size_t k, float limit_squared, double* sum) {
    auto* it = static_cast<Index*>(index);
    it->indices.resize(k);
    it->distances.resize(k);
    nanoflann::KNNResultSet<float, uint32_t> result(k);
    result.init(it->indices.data(), it->distances.data());
    // The last entry is the limit while there are fewer than k.
    it->distances[k - 1] = limit_squared;
    it->tree.findNeighbors(result, p, nanoflann::SearchParams(32, 0, false));
    *sum = 0;
    for (size_t i = 0; i < result.size(); ++i) *sum += it->distances[i];
    return result.size();
}

size_t flann_within(void* index, const float* p, float limit_squared, double* sum) {
    auto* it = static_cast<Index*>(index);
    const size_t n = it->tree.radiusSearch(p, limit_squared, it->found, nanoflann::SearchParams(32, 0, false));
    *sum = 0;
    for (const auto& match : it->found) *sum += match.second;
    return n;
}
}
