using System;

namespace Wadi
{
    /// <summary>Looking inside.</summary>
    public sealed unsafe partial class World
    {
        /// <summary>Effects on and why, passes, buffers, bytes per cell, as text.</summary>
        public string DescribePlan()
        {
            var length = (ulong)Native.wadi_world_describe_plan(Id, null, UIntPtr.Zero);
            if (length == 0) throw new WadiException(Result.ErrorBadArgument, Text.Of(Native.wadi_get_last_error()));
            var text = new byte[length + 1];
            fixed (byte* to = text)
            {
                Native.wadi_world_describe_plan(Id, to, (UIntPtr)(ulong)text.LongLength);
                GC.KeepAlive(this);
                return Text.Of(to, text.Length);
            }
        }

        public EffectInfo[] GetEffects()
        {
            uint count = 0;
            Check(Native.wadi_world_get_effects(Id, null, &count));
            var effects = new EffectInfo[count];
            fixed (EffectInfo* to = effects) Check(Native.wadi_world_get_effects(Id, to, &count));
            return effects;
        }

        /// <summary>Every buffer that the world holds on its device.</summary>
        public MemoryItem[] GetMemory()
        {
            uint count = 0;
            Check(Native.wadi_world_get_memory(Id, null, &count));
            var items = new MemoryItem[count];
            fixed (MemoryItem* to = items) Check(Native.wadi_world_get_memory(Id, to, &count));
            return items;
        }

        /// <summary>Every step records timestamps; off at first.</summary>
        public void SetProfiling(bool on)
        {
            Check(Native.wadi_world_set_profiling(Id, on ? 1 : 0));
        }

        /// <summary>Every step is verified and throws, naming step, field and cell, where it breaks a promise; slow, off at first.</summary>
        public void SetChecking(bool on)
        {
            Check(Native.wadi_world_set_checking(Id, on ? 1 : 0));
        }

        /// <summary>Mean times of stages since profiling was switched on.</summary>
        public StageTiming[] GetStageTimings()
        {
            uint count = 0;
            Check(Native.wadi_world_get_stage_timings(Id, null, &count));
            var timings = new StageTiming[count];
            fixed (StageTiming* to = timings) Check(Native.wadi_world_get_stage_timings(Id, to, &count));
            return timings;
        }

        /// <summary>What the world submits next runs behind a CUDA event (cudaEvent_t, CUevent) of the host.</summary>
        public void CudaWait(IntPtr cudaEvent)
        {
            Check(Native.wadi_cuda_wait(Id, (void*)cudaEvent));
        }

        /// <summary>Records a CUDA event behind everything that the world submitted so far.</summary>
        public void CudaSignal(IntPtr cudaEvent)
        {
            Check(Native.wadi_cuda_signal(Id, (void*)cudaEvent));
        }

        /// <summary>Throws what broke the world for good; a fault that the device has not reported yet is not known.</summary>
        public void ThrowIfBroken()
        {
            Check(Native.wadi_world_get_error(Id));
        }
    }
}
