"""Pictures of items, where Matplotlib is installed."""

from importlib.util import find_spec

from treacle_figure import figure


def draw(item, plot, path):
    """Returns whether it was drawn."""
    if not find_spec("matplotlib"):
        return False
    with figure(path, item.title, plot.x_label, plot.y_label) as axes:
        for k, (name, (x, y)) in enumerate(plot.curves.items()):
            ours = name.startswith("ours")
            mark = None if len(x) > 30 else "osD^vP*X<>"[k % 10]
            axes.plot(x, y, marker=mark, markersize=4, linewidth=1.2, color="k" if ours else f"C{k % 10}", label=name)
        if plot.log_x:
            axes.set_xscale("log")
        if plot.log_y:
            axes.set_yscale("log")
        else:
            axes.set_ylim(bottom=0)
    return True
