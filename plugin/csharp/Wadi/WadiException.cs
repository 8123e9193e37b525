using System;

namespace Wadi
{
    /// <summary>A call that failed, with the library's own text: it names field, value and allowed range.</summary>
    public sealed class WadiException : Exception
    {
        public Result Result { get; private set; }

        internal WadiException(Result result, string message, Exception inner = null) : base(message, inner)
        {
            Result = result;
        }
    }
}
