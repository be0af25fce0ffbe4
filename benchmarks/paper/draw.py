"""Pictures of items, where matplotlib is installed."""


def draw(item, plot, path):
    """Returns whether it was drawn."""
    try:
        import matplotlib
    except ImportError:
        return False
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.4, 4.2), dpi=110, layout="constrained")
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
    axes.set_xlabel(plot.x_label)
    axes.set_ylabel(plot.y_label)
    axes.set_title(item.title, fontsize=10)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path)
    plt.close(figure)
    return True
