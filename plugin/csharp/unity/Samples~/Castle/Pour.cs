using UnityEngine;
using Wadi;

/// <summary>A brush: while a button of the mouse is held, water or sand falls where it points. Put it on the camera.</summary>
public sealed class Pour : MonoBehaviour
{
    public WadiTerrain terrain;
    [Tooltip("Radius of the brush [m].")]
    public float radius = 1.5f;
    [Tooltip("What is added at its middle in a second [m].")]
    public float rate = 1;

    bool pouring;
    Layer layer;
    Vector2 pointer;

    // Events of the old interface reach a script whichever input system the project has chosen.
    void OnGUI()
    {
        GUI.Label(new Rect(10, 10, 600, 30), "Hold the left button to pour water, the right one to pour sand.");
        var now = Event.current;
        pointer = new Vector2(now.mousePosition.x, Screen.height - now.mousePosition.y); // counted from the bottom, as cameras do
        if (now.type == EventType.MouseUp) pouring = false;
        if (now.type != EventType.MouseDown) return;
        pouring = true;
        layer = now.button == 0 ? Layer.Water : Layer.Sand;
    }

    void FixedUpdate()
    {
        Vector3 where;
        if (pouring && terrain.World != null && terrain.Raycast(GetComponent<Camera>().ScreenPointToRay(pointer), 200, out where))
            terrain.Pour(where, layer, radius, rate * Time.fixedDeltaTime);
    }
}
