// Makes Embree 3.13 and 4 look alike: wraps what has another name in each. In: rays in Embree's layouts. Out: the same
// rays with what they meet.
#pragma once

#include <type_traits>

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace framelet {

#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
/// Lets a query bring a filter of its own.
inline constexpr RTCSceneFlags query_filters = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
using EmbreeContext = RTCIntersectContext;
inline constexpr RTCSceneFlags query_filters = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

/// Settings by which a packet is traced.
struct EmbreeQuery {
    EmbreeContext& context; ///< the filters find it in their arguments
    bool coherent; ///< its rays are near to each other
    RTCFilterFunctionN filter = nullptr; ///< the query's own
};

#if RTC_VERSION_MAJOR >= 4

inline void begin_query(EmbreeQuery const& query) {
    rtcInitRayQueryContext(&query.context);
}

template <class Arguments>
void fill_arguments(EmbreeQuery const& query, Arguments& out) {
    out.context = &query.context;
    out.flags = static_cast<RTCRayQueryFlags>(
        (query.coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT) |
        (query.filter ? RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER : RTC_RAY_QUERY_FLAG_NONE));
    out.filter = query.filter;
}

/// Finds the nearest hits; for a ray that has met something already, only what is nearer.
template <class RayHits>
void intersect(EmbreeQuery const& query, int const* valid, RTCScene scene, RayHits& rays) {
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    fill_arguments(query, arguments);
    if constexpr (std::is_same_v<RayHits, RTCRayHit16>) {
        rtcIntersect16(valid, scene, &rays, &arguments);
    } else {
        rtcIntersect8(valid, scene, &rays, &arguments);
    }
}

template <class Rays>
void occlude(EmbreeQuery const& query, int const* valid, RTCScene scene, Rays& rays) {
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    fill_arguments(query, arguments);
    if constexpr (std::is_same_v<Rays, RTCRay16>) {
        rtcOccluded16(valid, scene, &rays, &arguments);
    } else {
        rtcOccluded8(valid, scene, &rays, &arguments);
    }
}

#else

inline void begin_query(EmbreeQuery const& query) {
    rtcInitIntersectContext(&query.context);
    query.context.flags = query.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    query.context.filter = query.filter;
}

/// Finds the nearest hits; for a ray that has met something already, only what is nearer.
template <class RayHits>
void intersect(EmbreeQuery const& query, int const* valid, RTCScene scene, RayHits& rays) {
    if constexpr (std::is_same_v<RayHits, RTCRayHit16>) {
        rtcIntersect16(valid, scene, &query.context, &rays);
    } else {
        rtcIntersect8(valid, scene, &query.context, &rays);
    }
}

template <class Rays>
void occlude(EmbreeQuery const& query, int const* valid, RTCScene scene, Rays& rays) {
    if constexpr (std::is_same_v<Rays, RTCRay16>) {
        rtcOccluded16(valid, scene, &query.context, &rays);
    } else {
        rtcOccluded8(valid, scene, &query.context, &rays);
    }
}

#endif

} // namespace framelet
