#pragma once

/// Marks a function as callable on the host and, when compiled by nvcc, on the device.
#ifdef __CUDACC__
#define TREACLE_HD __host__ __device__
#else
#define TREACLE_HD
#endif

/// INSTANTIATE(Backend) for each backend of this build: explicit instantiation of what is generic over both.
#ifdef TREACLE_HAS_CUDA
#define TREACLE_FOR_EACH_BACKEND(INSTANTIATE) INSTANTIATE(Cpu) INSTANTIATE(Cuda)
#else
#define TREACLE_FOR_EACH_BACKEND(INSTANTIATE) INSTANTIATE(Cpu)
#endif
