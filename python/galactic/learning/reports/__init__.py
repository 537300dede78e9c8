"""What people look at: the progress line, curves and their page, contact sheets and videos."""
