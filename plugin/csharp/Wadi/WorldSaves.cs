using System;
using System.Collections.Generic;
using System.Runtime.InteropServices;

namespace Wadi
{
    /// <summary>Saving, going back, the command log.</summary>
    public sealed unsafe partial class World
    {
        /// <summary>Memory that the library's worker may still write to, by ticket.</summary>
        readonly Dictionary<ulong, GCHandle> pinnedSaves = new Dictionary<ulong, GCHandle>();

        void FreePinnedSaves()
        {
            foreach (var save in pinnedSaves.Values) save.Free();
            pinnedSaves.Clear();
        }

        /// <summary>The state, to the bit. Waits for the steps.</summary>
        public byte[] Save()
        {
            UIntPtr size;
            Check(Native.wadi_world_save(Id, null, &size));
            var data = new byte[(ulong)size];
            fixed (byte* to = data) Check(Native.wadi_world_save(Id, to, &size));
            return data;
        }

        /// <summary>Goes to a saved state of a world of the same level settings.</summary>
        public void Load(byte[] snapshot)
        {
            if (snapshot == null) throw new ArgumentNullException("snapshot");
            fixed (byte* from = snapshot) Check(Native.wadi_world_load(Id, from, (UIntPtr)(ulong)snapshot.LongLength));
        }

        /// <summary>What Load of these bytes would cost; the world stays as it is.</summary>
        public Cost CostOfSnapshot(byte[] snapshot)
        {
            if (snapshot == null) throw new ArgumentNullException("snapshot");
            var cost = Cost.Default;
            fixed (byte* from = snapshot) Check(Native.wadi_world_get_snapshot_cost(Id, from, (UIntPtr)(ulong)snapshot.LongLength, &cost));
            return cost;
        }

        /// <summary>What PlayCommands of these bytes would cost; nothing is queued.</summary>
        public Cost CostOfCommands(byte[] commands)
        {
            if (commands == null) throw new ArgumentNullException("commands");
            var cost = Cost.Default;
            fixed (byte* from = commands) Check(Native.wadi_world_get_commands_cost(Id, from, (UIntPtr)(ulong)commands.LongLength, &cost));
            return cost;
        }

        /// <summary>Save to a file, which is replaced whole or not at all.</summary>
        public void SaveFile(string path)
        {
            fixed (byte* text = Text.Utf8(path, "path")) Check(Native.wadi_world_save_file(Id, text));
        }

        public void LoadFile(string path)
        {
            fixed (byte* text = Text.Utf8(path, "path")) Check(Native.wadi_world_load_file(Id, text));
        }

        /// <summary>Asks for a snapshot without waiting; false while an earlier one is under way.</summary>
        public bool TryBeginSave(out ulong ticket)
        {
            ulong given = 0;
            bool ready = Ready(Native.wadi_world_begin_save(Id, &given));
            ticket = given;
            if (ready) FreePinnedSaves(); // of an earlier save that nobody fetched: the library has let go of it
            return ready;
        }

        /// <summary>Fetches it: null until it is there, then the snapshot, once.</summary>
        public byte[] TryEndSave(ulong ticket)
        {
            UIntPtr size;
            GCHandle pinned;
            if (!pinnedSaves.TryGetValue(ticket, out pinned))
            {
                if (!Ready(Native.wadi_world_end_save(Id, ticket, null, &size))) return null;
                pinned = GCHandle.Alloc(new byte[(ulong)size], GCHandleType.Pinned);
                pinnedSaves.Add(ticket, pinned);
            }
            var data = (byte[])pinned.Target;
            size = (UIntPtr)(ulong)data.LongLength;
            if (!Ready(Native.wadi_world_end_save(Id, ticket, (void*)pinned.AddrOfPinnedObject(), &size))) return null;
            pinnedSaves.Remove(ticket);
            pinned.Free();
            return data;
        }

        /// <summary>Keeps the newest states on the device: those of every step that is a multiple of intervalSteps; 0 frames = off.</summary>
        public void SetRollback(uint frames, uint intervalSteps)
        {
            Check(Native.wadi_world_set_rollback(Id, frames, intervalSteps));
        }

        /// <summary>Steps that can be gone back to, oldest first.</summary>
        public ulong[] GetRollbackSteps()
        {
            uint count = 0;
            Check(Native.wadi_world_get_rollback_steps(Id, null, &count));
            var steps = new ulong[count];
            fixed (ulong* to = steps) Check(Native.wadi_world_get_rollback_steps(Id, to, &count));
            return steps;
        }

        /// <summary>Goes back to the newest kept step that is not after `step`, and returns it.</summary>
        public ulong RollBack(ulong step)
        {
            ulong reached;
            Check(Native.wadi_world_roll_back(Id, step, &reached));
            return reached;
        }

        /// <summary>Remembers every edit, written region, trim and change of the material with its step; off drops them.</summary>
        public void SetCommandLog(bool on)
        {
            Check(Native.wadi_world_set_command_log(Id, on ? 1 : 0));
        }

        /// <summary>The command log as bytes.</summary>
        public byte[] GetCommands()
        {
            UIntPtr size;
            Check(Native.wadi_world_get_commands(Id, null, &size));
            var data = new byte[(ulong)size];
            fixed (byte* to = data) Check(Native.wadi_world_get_commands(Id, to, &size));
            return data;
        }

        /// <summary>Of the log what counts ahead of `step` or a later one, of one player or of every one: what a lockstep game sends.</summary>
        public byte[] GetCommandsSince(ulong step, ulong player = ulong.MaxValue)
        {
            UIntPtr size;
            Check(Native.wadi_world_get_commands_since(Id, step, player, null, &size));
            var data = new byte[(ulong)size];
            fixed (byte* to = data) Check(Native.wadi_world_get_commands_since(Id, step, player, to, &size));
            return data;
        }

        /// <summary>Queues the commands of a log in a world of the same level: after the same number of steps the hash is the same.</summary>
        public void PlayCommands(byte[] commands)
        {
            if (commands == null) throw new ArgumentNullException("commands");
            fixed (byte* from = commands) Check(Native.wadi_world_play_commands(Id, from, (UIntPtr)(ulong)commands.LongLength));
        }
    }
}
