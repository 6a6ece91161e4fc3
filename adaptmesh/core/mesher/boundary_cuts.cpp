#include "adaptmesh/core/mesher/boundary_cuts.hpp"

#include <algorithm>

#include "adaptmesh/core/triangulation/edge_map.hpp"

namespace adaptmesh {

namespace {

// Keeps the items that are not marked.
template <typename T>
void drop(std::vector<T>& items, const std::vector<char>& marks) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (!marks[i]) items[kept++] = items[i];
    }
    items.resize(kept);
}

bool any(const std::vector<char>& marks) {
    return std::find(marks.begin(), marks.end(), true) != marks.end();
}

}  // namespace

std::vector<std::size_t> BoundaryCuts::first_cuts() const {
    std::vector<std::size_t> first(pieces.size() + 1, 0);
    for (Index piece : cut_pieces) ++first[piece + 1];
    for (std::size_t p = 0; p < pieces.size(); ++p) first[p + 1] += first[p];
    return first;
}

bool BoundaryCuts::mend(const std::vector<char>& is_made) {
    std::vector<char> hidden(pieces.size(), false);
    for (std::size_t i = 0; i < cuts.size(); ++i) {
        if (!is_made[i] && pieces[cut_pieces[i]].is_chord) hidden[cut_pieces[i]] = true;
    }
    if (any(hidden)) {
        divide(hidden);
        return true;
    }
    const std::vector<char> torn = torn_ties(is_made);
    if (!any(torn)) return false;
    drop(cuts, torn), drop(cut_tensors, torn), drop(cut_pieces, torn);
    return true;
}

InputError BoundaryCuts::in_the_domain(const InputError& fault) const {
    const auto segment_at = [&](Index point) {
        const auto ends_there = [&](Segment s) { return s.a == point || s.b == point; };
        const auto found = std::find_if(segments.begin(), segments.end(), ends_there);
        return Index(found == segments.end() ? 0 : found - segments.begin());
    };
    Index i = fault.i, j = fault.j;
    if (fault.kind == InputFault::duplicate_points)
        i = segment_at(i), j = segment_at(j);
    else if (fault.kind != InputFault::crossing_segments &&
             fault.kind != InputFault::overlapping_segments)
        return fault;
    return InputError(InputFault::lines_too_near, owners[i], owners[j], fault.at);
}

// Their cuts become points, and the chords between these take their place.
void BoundaryCuts::divide(const std::vector<char>& chords) {
    const std::vector<std::size_t> first = first_cuts();
    std::vector<Piece> gone, parts;
    std::vector<Index> number(pieces.size());
    std::vector<char> becomes_point(cuts.size(), false);
    for (std::size_t p = 0, kept = 0; p < pieces.size(); ++p) {
        number[p] = Index(kept);
        if (!chords[p]) {
            ++kept;
            continue;
        }
        const Piece piece = pieces[p];
        gone.push_back(piece);
        Index from = piece.a;
        for (std::size_t i = first[p]; i < first[p + 1]; ++i) {
            becomes_point[i] = true;
            parts.push_back({from, Index(points.size()), piece.segment, true});
            from = Index(points.size());
            points.push_back(cuts[i]);
            tensors.push_back(cut_tensors[i]);
        }
        parts.push_back({from, piece.b, piece.segment, true});
    }

    const EdgeNumbers lookup(gone);
    std::vector<char> is_gone(segments.size());
    for (std::size_t i = 0; i < segments.size(); ++i)
        is_gone[i] = lookup.find(segments[i].a, segments[i].b) != NONE;
    drop(segments, is_gone), drop(owners, is_gone);
    drop(pieces, chords);
    for (const Piece& part : parts) {
        segments.push_back({part.a, part.b});
        owners.push_back(part.segment);
        pieces.push_back(part);
    }
    drop(cuts, becomes_point), drop(cut_tensors, becomes_point), drop(cut_pieces, becomes_point);
    for (Index& piece : cut_pieces) piece = number[piece];
}

// The cuts of tied pieces that are not made on both.
std::vector<char> BoundaryCuts::torn_ties(const std::vector<char>& is_made) const {
    const std::vector<std::size_t> first = first_cuts();
    std::vector<char> out(cuts.size(), false);
    for (const Tie& tie : ties) {
        const std::size_t n = first[tie.piece + 1] - first[tie.piece];
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t mine = first[tie.piece] + k;
            const std::size_t other = first[tie.image] + (tie.is_reversed ? n - 1 - k : k);
            if (!is_made[mine] || !is_made[other]) out[mine] = out[other] = true;
        }
    }
    return out;
}

}  // namespace adaptmesh
