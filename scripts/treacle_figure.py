"""Pictures in one style, for the validation studies and the reproduction of the papers; needs Matplotlib."""

from contextlib import contextmanager


@contextmanager
def figure(path, title, x_label, y_label):
    """Gives axes to draw on, and then writes the picture (PNG), whose folder it makes. Raises ImportError without Matplotlib."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    drawn, axes = plt.subplots(figsize=(6.4, 4.2), dpi=110, layout="constrained")
    yield axes
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.set_title(title, fontsize=10)
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7)
    path.parent.mkdir(parents=True, exist_ok=True)
    drawn.savefig(path)
    plt.close(drawn)
