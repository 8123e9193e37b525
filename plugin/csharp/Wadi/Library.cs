using System;

namespace Wadi
{
    /// <summary>What the library tells without a world.</summary>
    public static unsafe class Library
    {
        static bool loaded;

        /// <summary>Finds the library and compares versions; everything else here and World do it first.</summary>
        /// <exception cref="DllNotFoundException">there is none; the text says where it is looked for</exception>
        /// <exception cref="WadiException">it does not fit this binding</exception>
        public static void Load()
        {
            if (loaded) return;
            uint abi, version;
            try
            {
                abi = Native.wadi_get_abi_version();
                version = Native.wadi_get_version();
            }
            catch (DllNotFoundException e)
            {
                throw new DllNotFoundException("Wadi's library was not found. libwadi.so (Linux), libwadi.dll (Windows) or libwadi.dylib (macOS), for this "
                    + "process's " + (IntPtr.Size * 8) + " bits, must lie beside the program, in a folder that LD_LIBRARY_PATH (Windows: "
                    + "PATH) names, or in Runtime/Plugins of the Unity package. The system says: " + e.Message, e);
            }
            catch (EntryPointNotFoundException e)
            {
                throw new WadiException(Result.ErrorNotSupported, "The library libwadi that was found is not Wadi's: " + e.Message, e);
            }
            if (abi != Header.AbiVersion)
                throw new WadiException(Result.ErrorNotSupported,
                    "libwadi has ABI version " + abi + ", this binding needs " + Header.AbiVersion);
            if (version < Header.Version)
                throw new WadiException(Result.ErrorNotSupported,
                    "libwadi is version " + Written(version) + ", this binding needs " + Written(Header.Version) + " or newer");
            loaded = true;
        }

        static string Written(uint version)
        {
            return (version >> 22) + "." + ((version >> 12) & 1023) + "." + (version & 4095);
        }

        /// <summary>Version of the library that is loaded, "0.1.0".</summary>
        public static string Version
        {
            get
            {
                Load();
                return Written(Native.wadi_get_version());
            }
        }

        /// <summary>Throws what the newest call on this thread said.</summary>
        internal static void Check(Result result)
        {
            if (result != Result.Ok) throw new WadiException(result, Text.Of(Native.wadi_get_last_error()));
        }

        /// <summary>All devices of all backends; notes has a line per backend without one, saying why.</summary>
        public static DeviceInfo[] ListDevices(out string notes)
        {
            Load();
            uint count = 0;
            var text = new byte[4096];
            fixed (byte* written = text)
            {
                Check(Native.wadi_list_devices(null, &count, written, (UIntPtr)(uint)text.Length));
                notes = Text.Of(written, text.Length);
            }
            var devices = new DeviceInfo[count];
            for (int n = 0; n < devices.Length; ++n) devices[n] = DeviceInfo.Default;
            fixed (DeviceInfo* infos = devices) Check(Native.wadi_list_devices(infos, &count, null, UIntPtr.Zero));
            return devices;
        }

        /// <summary>Accuracy presets by rising accuracy.</summary>
        public static AccuracyPreset[] ListAccuracyPresets()
        {
            Load();
            uint count = 0;
            Check(Native.wadi_list_accuracy_presets(null, &count));
            var raw = new RawAccuracyPreset[count];
            fixed (RawAccuracyPreset* presets = raw) Check(Native.wadi_list_accuracy_presets(presets, &count));
            return Array.ConvertAll(raw, preset => new AccuracyPreset(preset));
        }

        /// <summary>A table as text: "settings", "effects", "fields", "stages" or "schema".</summary>
        public static string DescribeTable(string table)
        {
            Load();
            fixed (byte* name = Text.Utf8(table, "table"))
            {
                var length = (ulong)Native.wadi_describe_table(name, null, UIntPtr.Zero);
                if (length == 0) throw new WadiException(Result.ErrorBadArgument, Text.Of(Native.wadi_get_last_error()));
                var text = new byte[length + 1];
                fixed (byte* written = text)
                {
                    Native.wadi_describe_table(name, written, (UIntPtr)(uint)text.Length);
                    return Text.Of(written, text.Length);
                }
            }
        }

        /// <summary>Short name of a field, "hs"; null where there is none.</summary>
        public static string FieldName(Field field)
        {
            Load();
            return Text.Of(Native.wadi_field_name(field));
        }
    }
}
